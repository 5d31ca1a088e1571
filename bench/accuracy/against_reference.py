#!/usr/bin/env python3
"""Processor time of `fluxel solve --target-error` against that of `fluxel reference` at the same true error of the picture.

    source scripts/mpi-env.sh; bench/accuracy/against_reference.py --csv bench/results/accuracy/against-reference.csv
        [--hall modern-hall.obj] [--staircase wooden-staircase.obj] [--rooms SEED ...] [--targets 0.05 0.02]
        [--again NAME ...]

solves pictures of 400x300 pixels by one thread of one rank. SEED is that of a room of bench/calibration/random_rooms.py.

The true error is that of `fluxel compare` against a long reference: root mean square over the pixels, over their mean, of the
worst colour, without the noise of the reference. A picture by paths is unbiased, so that its true error is its standard
error, which `fluxel reference` states after each pass together with the processor time so far. It runs as is best for it: the
picture alone, one point in a pixel as in the solve's picture, its own Sobol sequences, one thread. Its time to an error is
taken from the pass whose error is nearest, by the power of time with which the errors of all passes fall (a straight line of
least squares through their logarithms; of a single pass that of independent paths). Errors beyond those of the passes are
*extrapolated*; above the first of them (64 paths a pixel) that is to the reference's advantage, as it makes no shorter ones,
and so are paths of rare, large values that none has found yet. To it comes the time of loading the scene, that of the solve.
Where both are equal the ratio is 1; above it `fluxel solve` is faster. Its interval is that of one standard error of the true
error; where noise hides that, its upper end takes its place.

Times [s] of processor time: those of a solve are of the whole run, the median of five of runs below three seconds. Those of
references are as they were measured when it was made: remove its folder in build/references to measure them again.

Rows that the CSV file has are kept, and only what is not there is measured; --again measures those of these scenes and the
given targets once more. Prints all rows of the file as a Markdown table. Needs build/release (scripts/build).
"""

import argparse
import dataclasses
import statistics
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True

from reference_slope import slope
from rows import read_rows, write_rows
from runs import Solves, compare, load, reference_of
from settings import HIERARCHICAL, ROOT, Scene, Setting, modern_hall, wooden_staircase

sys.path.append(str(ROOT / "bench/calibration"))
from random_rooms import make_room

WIDTH, HEIGHT = 400, 300
OF_INDEPENDENT_PATHS = -0.5
FIELDS = ("scene", "target", "stated", "reached", "true", "true_low", "true_high", "bias", "noise", "cpu_s", "load_cpu_s", "runs",
          "exchange", "pass_error", "pass_cpu_s", "first_error", "last_error", "power", "reference_cpu_s", "ratio", "ratio_low",
          "ratio_high", "limit_s")


def scenes_of(arguments, folder):
    """With the picture's size among their options."""
    scenes = [modern_hall(arguments.hall)] if arguments.hall else []
    scenes += [wooden_staircase(arguments.staircase)] if arguments.staircase else []
    for scene in scenes:
        yield dataclasses.replace(scene, options=(*scene.options, "--resolution", f"{WIDTH}x{HEIGHT}"))
    for seed in arguments.rooms:
        room, obj = make_room(seed), folder / f"room-{seed}.obj"
        room.write(obj)
        yield Scene(obj.stem, obj, (), (), room.options(WIDTH))


@dataclasses.dataclass(frozen=True)
class Passes:
    """Of a reference: (processor time [s], error) of each."""

    points: tuple

    @property
    def power(self):
        """Of time, with which the error falls."""
        return slope(self.points) if len(self.points) > 1 else OF_INDEPENDENT_PATHS

    def nearest(self, error):
        return min(self.points, key=lambda point: abs(point[1] - error))

    def seconds_to(self, error):
        seconds, of_pass = self.nearest(error)
        return seconds * (error / of_pass) ** (1 / self.power) if error > 0 else float("inf")


def measure(scene, target, arguments):
    """A row; of a run that has been ended without anything but what it was asked for."""
    row = {"scene": scene.name, "target": target, "limit_s": arguments.limit}
    reference = reference_of(f"{scene.name}-{WIDTH}x{HEIGHT}", scene.file, scene.options, arguments.reference_error,
                             arguments.reference_seconds, 1)
    measured = load(reference / "reference.json")["measured"]["picture"]["passes"]
    passes = Passes(tuple((state["cpu_s"], max(state["relative_error_rgb"])) for state in measured))
    with Solves(scene, 1, arguments.limit) as solves:
        report = solves.run(Setting(HIERARCHICAL, 0, WIDTH, (*scene.options, "--target-error", str(target))))
        if report is None:
            return row
        true = compare(solves.out / "image.exr", reference / "reference.exr", solves.folder / "compare")
    cpu_s, load_s = statistics.median(report["seconds"]["cpu"]), report["cpu_s"]["load"]
    to = lambda error: load_s + passes.seconds_to(error)
    told = true["error"] or true["high"]
    seconds, error = passes.nearest(told)
    return row | {"stated": report["stated_error"], "reached": report["hierarchy"].get("reached"), "true": true["error"],
                  "true_low": true["low"], "true_high": true["high"], "bias": true["bias"], "noise": true["noise"],
                  "cpu_s": cpu_s, "load_cpu_s": load_s, "runs": len(report["seconds"]["cpu"]),
                  "exchange": report["hierarchy"]["exchange"], "pass_error": error, "pass_cpu_s": seconds,
                  "first_error": passes.points[0][1], "last_error": passes.points[-1][1], "power": passes.power,
                  "reference_cpu_s": to(told), "ratio": to(told) / cpu_s,
                  "ratio_low": to(true["high"]) / cpu_s, "ratio_high": to(true["low"]) / cpu_s}


def ended(row):
    return row.get("ratio", "") == ""


def how(row):
    """The reference's time to the error is known."""
    if row["first_error"] >= row["true"] >= row["last_error"]:
        return "measured"
    return f"extrapolated from {row['pass_error']:.2%} in {row['pass_cpu_s']:.1f} s"


def print_table(rows):
    print("| scene | target | stated | reached | true (one standard error) | bias | exchange | solve | "
          "reference, to the same error | how | ratio (one standard error) |\n" + "| --- " * 11 + "|")
    for row in rows:
        start = f"| {row['scene']} | {row['target']:.0%} |"
        if ended(row):
            print(f"{start} without a result after {row['limit_s']:.0f} s |" + " - |" * 8)
            continue
        print(f"{start} {row['stated']:.2%} | {row['reached']} | {row['true']:.2%} ({row['true_low']:.2%} to "
              f"{row['true_high']:.2%}) | {row['bias']:+.2%} | {row['exchange']} | {row['cpu_s']:.2f} s | "
              f"{row['reference_cpu_s']:.2f} s | {how(row)} | {row['ratio']:.2g} ({row['ratio_low']:.2g} to "
              f"{row['ratio_high']:.2g}) |")
    told = [row for row in rows if not ended(row)]
    if told:
        print(f"\nfaster by {statistics.median(row['ratio'] for row in told):.2g} in the median of {len(told)}")
        lost = [f"{row['scene']} at {row['target']:.0%} ({row['ratio']:.2g})" for row in told if row["ratio"] < 1]
        print("slower than the reference: " + (", ".join(lost) or "none"))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--csv", type=Path, required=True)
    parser.add_argument("--hall", type=Path, help="modern-hall.obj")
    parser.add_argument("--staircase", type=Path, help="wooden-staircase.obj")
    parser.add_argument("--rooms", type=int, nargs="+", default=(), metavar="SEED")
    parser.add_argument("--targets", type=float, nargs="+", default=(0.05, 0.02))
    parser.add_argument("--again", nargs="+", default=(), metavar="NAME", help="of a scene, as in the table")
    parser.add_argument("--limit", type=float, default=1200, help="seconds that a solve may take")
    parser.add_argument("--reference-error", type=float, default=0.02, help="of a long reference, over the mean")
    parser.add_argument("--reference-seconds", type=float, default=900, help="that it may take")
    arguments = parser.parse_args()

    arguments.csv.parent.mkdir(parents=True, exist_ok=True)
    rows = {(row["scene"], row["target"]): row for row in read_rows(arguments.csv, FIELDS)}
    with tempfile.TemporaryDirectory(prefix="fluxel-against-") as folder:
        for scene in scenes_of(arguments, Path(folder)):
            for target in arguments.targets:
                key = (scene.name, target)
                if key in rows and not ended(rows[key]) and scene.name not in arguments.again:
                    continue
                rows[key] = measure(scene, target, arguments)
                write_rows(arguments.csv, FIELDS, rows.values())
    print_table(rows.values())


if __name__ == "__main__":
    main()
