#!/usr/bin/env python3
"""Repeats the table of speed-ups of Debelov & Sattarov, section 5.2, on a scene of 2391 triangles of our own.

    source scripts/mpi-env.sh; /usr/bin/python3 bench/speedup/speedup.py --out out/speedup
    /usr/bin/python3 bench/speedup/speedup.py --np 1,2 --resolution 32x32 --repeat 3 --out out/speedup   # a short trial

Needs build/release (scripts/build) and matplotlib. Prints the table, and writes it into OUT as speedup.md, speedup.csv,
speedup.png and phases.png. One thread a rank; repetitions take turns, and the run of median wall-clock time counts.
"""

import argparse
import os
import sys
from pathlib import Path

import chart
from jobs import FLUXEL, cores, median_run, run, spread
from tables import Comparison, as_markdown, as_text, paper_rows, phase_rows, write_csv


def rank_counts(text):
    counts = sorted({int(part) for part in text.split(",")})
    if not counts or counts[0] < 1:
        raise argparse.ArgumentTypeError("numbers of ranks from 1 up, as 1,2,4")
    return counts


def read_arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--np", type=rank_counts, default=list(range(1, 11)), metavar="LIST", help="default: 1 to 10")
    parser.add_argument("--resolution", default="128x128", metavar="WxH",
                        help="of the camera, and so of the elements; the default takes a minute and more on one rank")
    parser.add_argument("--repeat", type=int, default=1, metavar="N", help="runs for each number of ranks")
    parser.add_argument("--out", type=Path, required=True, metavar="DIR")
    return parser.parse_args()


def allow_crowding(most_ranks):
    """More ranks than cores: Open MPI must permit it, and waiting ranks must give the core away."""
    if most_ranks > cores():
        os.environ["OMPI_MCA_rmaps_base_oversubscribe"] = "1"
        os.environ["PRTE_MCA_rmaps_default_mapping_policy"] = ":oversubscribe"
        os.environ["OMPI_MCA_mpi_yield_when_idle"] = "1"


def measure(arguments):
    """Ranks -> all their runs."""
    runs = {ranks: [] for ranks in arguments.np}
    for repetition in range(arguments.repeat):
        for ranks in arguments.np:
            done = run(ranks, arguments.resolution)
            runs[ranks].append(done)
            print(f"run {repetition + 1}, np {ranks}: {done.wall:.1f} s, {done.cpu:.1f} s of processor time",
                  file=sys.stderr)
    return runs


def main():
    arguments = read_arguments()
    if not FLUXEL.exists():
        sys.exit(f"{FLUXEL} is not there: run scripts/build first")
    arguments.out.mkdir(parents=True, exist_ok=True)
    allow_crowding(max(arguments.np))
    runs = measure(arguments)
    comparison = Comparison({ranks: median_run(of_ranks) for ranks, of_ranks in runs.items()}, cores())
    if len({run.hash for run in comparison.runs.values()}) != 1:
        sys.exit("the visibility bits differ between numbers of ranks: the table would compare different work")

    elements = next(iter(comparison.runs.values())).elements
    title = (f"office-2391 at {arguments.resolution}: {elements} elements, one thread a rank, median of "
             f"{arguments.repeat} run(s), spread up to {100 * max(map(spread, runs.values())):.0f} %")
    tables = [paper_rows(comparison), phase_rows(comparison)]
    print(f"\n{title}\n{comparison.note()}")
    for rows in tables:
        print(f"\n{as_text(rows)}")
    markdown = "\n\n".join([title + ".", comparison.note(), *map(as_markdown, tables)])
    (arguments.out / "speedup.md").write_text(markdown + "\n", encoding="utf-8")
    write_csv(arguments.out / "speedup.csv", comparison)
    chart.draw_speedup(comparison, arguments.out / "speedup.png")
    chart.draw_phases(comparison, arguments.out / "phases.png")


if __name__ == "__main__":
    main()
