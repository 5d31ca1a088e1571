#!/usr/bin/env python3
"""How time and memory of the hierarchical method grow with N, one thread of one rank.

    bench/growth/growth.py --csv bench/results/growth/hierarchy-growth.csv
                           [--image bench/results/growth/hierarchy-growth.png]
                           [--families NAME ...] [--most N]

measures three families and prints the exponents of processor time, memory and links in N, of least squares through the
logarithms over sizes from 10,000 on:

* detail: a room whose floor carries ever more and smaller boxes, `--block-error 1e-3`; N are the leaves;
* accuracy: the Cornell box at ever smaller `--block-error`; N are the leaves;
* picture: the Cornell box at `--block-error 1e-4`, in ever finer pictures; N are the camera's elements, whose light is
  gathered from links that stay what they are, with one more point for each pixel.

Families that are not measured keep their rows in the CSV file. Needs build/release (scripts/build), numpy and
matplotlib.
"""

import argparse
import csv
import json
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.dont_write_bytecode = True

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot
import numpy

from field import write_field

ROOT = Path(__file__).resolve().parents[2]
FLUXEL = ROOT / "build/release/app/fluxel"
CORNELL = ROOT / "scenes/cornell-box/cornell-box.toml"
FIELDS = ("family", "parameter", "n", "leaves", "links", "pairs", "rays", "gather_rays", "cpu_s", "load_cpu_s",
          "solve_cpu_s", "gather_cpu_s", "bytes_max", "peak_rss")
LEAST = 10_000  # below, what does not depend on N counts


@dataclass(frozen=True)
class Family:
    name: str
    parameters: tuple
    count: str  # of the report: what N is
    words: str  # of the parameter


FAMILIES = (
    Family("detail", (20, 45, 80, 141, 250, 400), "leaves", "boxes a side"),
    Family("accuracy", (1e-4, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7), "leaves", "block error"),
    Family("picture", (64, 128, 256, 512, 1024), "elements", "pixels a side"),
)


def arguments_of(family, parameter, folder):
    """What fluxel solves, and how."""
    if family.name == "detail":
        field = folder / "field.obj"
        write_field(field, parameter)
        return field, "--sides", "one", "--subdivision", "transport", "--block-error", "1e-3"
    if family.name == "accuracy":
        return CORNELL, "--subdivision", "transport", "--resolution", "16x16", "--block-error", str(parameter)
    return CORNELL, "--subdivision", "camera", "--resolution", f"{parameter}x{parameter}", "--block-error", "1e-4"


def measure(family, parameter):
    """Solves; a row of the table."""
    with tempfile.TemporaryDirectory(prefix="fluxel-growth-") as name:
        folder = Path(name)
        command = [FLUXEL, "solve", "--method", "hierarchical", *arguments_of(family, parameter, folder), "--threads", 1,
                   "--out", folder / "out", "--quiet"]
        subprocess.run([str(part) for part in command], check=True)
        report = json.loads((folder / "out" / "report.json").read_text(encoding="utf-8"))
    hierarchy, cpu = report["hierarchy"], report["cpu_s"]
    last = hierarchy["rounds"][-1]
    return {"family": family.name, "parameter": parameter,
            "n": report["elements"] if family.count == "elements" else last["leaves"], "leaves": last["leaves"],
            "links": last["links"], "pairs": hierarchy["node_pairs_looked_at"], "rays": hierarchy["rays"],
            "gather_rays": hierarchy["gather_rays"], "cpu_s": cpu["total"], "load_cpu_s": cpu["load"],
            "solve_cpu_s": cpu["solve"], "gather_cpu_s": cpu["gather"], "bytes_max": hierarchy["bytes_max"],
            "peak_rss": report["memory"]["peak_rss_bytes_max"]}


def exponent(rows, what):
    """Of the power of N that fits best; None for fewer than two sizes."""
    rows = [row for row in rows if row["n"] >= LEAST and row[what] > 0]
    if len(rows) < 2:
        return None
    return numpy.polyfit(numpy.log([row["n"] for row in rows]), numpy.log([row[what] for row in rows]), 1)[0]


def read(path):
    if not path.exists():
        return []
    with open(path, encoding="utf-8") as file:
        return [{key: value if key == "family" else float(value) for key, value in row.items()}
                for row in csv.DictReader(file)]


def write(path, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, FIELDS)
        writer.writeheader()
        writer.writerows(rows)


def print_exponents(rows):
    columns = ("cpu_s", "solve_cpu_s", "gather_cpu_s", "links", "bytes_max", "peak_rss")
    print("| family | N | " + " | ".join(columns) + " |\n" + "| --- " * (len(columns) + 2) + "|")
    for family in FAMILIES:
        of_family = [row for row in rows if row["family"] == family.name]
        if not of_family:
            continue
        cells = [exponent(of_family, what) for what in columns]
        print(f"| {family.name} | {min(row['n'] for row in of_family):,.0f} to "
              f"{max(row['n'] for row in of_family):,.0f} | " +
              " | ".join("-" if cell is None else f"N^{cell:.2f}" for cell in cells) + " |")


def draw(path, rows):
    figure, panels = pyplot.subplots(1, 3, figsize=(12, 4.2), layout="constrained")
    panes = (("cpu_s", "processor time [s]", 1.0), ("peak_rss", "peak memory [MB]", 1e-6), ("links", "links", 1.0))
    for axes, (what, label, scale) in zip(panels, panes):
        axes.set(xscale="log", yscale="log", xlabel="N: leaves, or elements of the picture", ylabel=label)
        # Okabe & Ito's palette, told apart with any colour vision.
        for family, colour, marker in zip(FAMILIES, ("#0072B2", "#D55E00", "#009E73"), "os^"):
            of_family = sorted((row for row in rows if row["family"] == family.name), key=lambda row: row["n"])
            if not of_family:
                continue
            power = exponent(of_family, what)
            axes.plot([row["n"] for row in of_family], [scale * row[what] for row in of_family], color=colour,
                      marker=marker, markersize=5,
                      label=family.name + ("" if power is None else f": N^{power:.2f}"))
        ends, low, high = numpy.array(axes.get_xlim()), *axes.get_ylim()
        axes.plot(ends, numpy.sqrt(low * high / ends.prod()) * ends, color="#7F7F7F", linestyle=":", linewidth=1,
                  label="N")
        axes.set(xlim=ends, ylim=(low, high))
        axes.grid(which="major", color="#CCCCCC", linewidth=0.6)
        axes.legend(fontsize=8)
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--csv", type=Path, required=True)
    parser.add_argument("--image", type=Path)
    parser.add_argument("--families", nargs="*", choices=[family.name for family in FAMILIES],
                        default=[family.name for family in FAMILIES], help="to measure; none: chart the rows there are")
    parser.add_argument("--most", type=float, default=3e6, help="a family ends where N would be above this")
    arguments = parser.parse_args()

    rows = [row for row in read(arguments.csv) if row["family"] not in arguments.families]
    for family in FAMILIES:
        if family.name not in arguments.families:
            continue
        before = None
        for parameter in family.parameters:
            # As it has grown by the last step, so by the next.
            if before is not None and before[1] * max(1.0, before[1] / before[0]) > arguments.most:
                break
            row = measure(family, parameter)
            before = (before[1] if before else row["n"], row["n"])
            rows.append(row)
            write(arguments.csv, rows)
            print(f"{family.name}: {family.words} {parameter:g}, N = {row['n']:,}, {row['links']:,} links, "
                  f"{row['cpu_s']:.2f} s, {row['peak_rss'] / 1e6:.0f} MB", flush=True)
    print_exponents(rows)
    if arguments.image:
        draw(arguments.image, rows)


if __name__ == "__main__":
    main()
