#!/usr/bin/env python3
"""How time and memory of the hierarchical method grow with N, one thread of one rank.

    bench/growth/growth.py --csv bench/results/growth/hierarchy-growth.csv
                           [--image bench/results/growth/hierarchy-growth.png]
                           [--families NAME ...] [--most N]

measures these families and prints the exponents of processor time, memory and links in N, of least squares through the
logarithms over sizes from 10,000 on:

* detail: a room whose floor carries ever more and smaller boxes, `--block-error 1e-3`; N are the leaves;
* accuracy: the Cornell box at ever smaller `--block-error`; N are the leaves;
* picture: the Cornell box at `--block-error 1e-4`, in ever finer pictures; N are the camera's elements, whose light is
  gathered from links that stay what they are, with one more point for each pixel;
* tessellation: one room of curved things (carved_room.py) made of 1, 4, 16 and 64 times as many triangles,
  `--target-error 0.05` at 200x150; N are the faces that are read. *tessellation-one-sided* is the same with
  `--sides one --exchange rays`: what lies behind the surfaces of this room gets no light, so that the truth is the same.

Of a tessellation a second table tells the times: refinement, iterations and audit in seconds of wall-clock time (of one
thread, on a quiet machine the processor time), as the report has them of the rounds and of the last audit, and in processor
time all that the rounds take (these, the tree, the estimates of errors), loading and picture; and how times grow from 4 to
64 times as many triangles. How many rounds there are depends on the bias that audits find, so that the first two, which all
sizes have, are told apart. Its true error is that of `fluxel compare` against a reference by paths of the same triangles,
kept in build/references; where none is there it is made first, with that standard error or in that time.

Families that are not measured keep their rows in the CSV file. Needs build/release (scripts/build), numpy and
matplotlib.
"""

import argparse
import os
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

sys.dont_write_bytecode = True

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot
import numpy

ROOT = Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "bench/accuracy")]

from carved_room import CAMERA, write_carved_room
from field import write_field
from rows import read_rows, write_rows
from runs import compare, fluxel, load, reference_of

CORNELL = ROOT / "scenes/cornell-box/cornell-box.toml"
FIELDS = ("family", "parameter", "n", "leaves", "links", "pairs", "rays", "gather_rays", "cpu_s", "load_cpu_s",
          "solve_cpu_s", "gather_cpu_s", "bytes_max", "peak_rss", "faces", "pieces", "exchange", "rows", "rounds", "refine_s",
          "iterate_s", "two_rounds_s", "audit_s", "stated", "reached", "true", "true_low", "true_high", "bias")
TESSELLATED = ("--target-error", "0.05", "--resolution", "200x150", *CAMERA)
FROM, TO = 4, 64  # times as many triangles: where growth is told
# Okabe & Ito's palette, told apart with any colour vision.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
COLUMNS = {  # of the table of tessellations
    "family": "{family}", "times": "{parameter:g}", "faces": "{faces:,.0f}", "pieces": "{pieces:,.0f}",
    "exchange": "{exchange}", "rows of rays": "{rows:,.0f}", "rounds": "{rounds:.0f}", "refinement": "{refine_s:.2f} s",
    "iterations": "{iterate_s:.2f} s", "both, first two rounds": "{two_rounds_s:.2f} s", "last audit": "{audit_s:.2f} s",
    "all rounds, processor time": "{solve_cpu_s:.2f} s", "loading": "{load_cpu_s:.2f} s", "picture": "{gather_cpu_s:.2f} s",
    "peak": "{peak_rss:.2e} B", "stated": "{stated:.2%}", "reached": "{reached}",
    "true (one standard error)": "{true:.2%} ({true_low:.2%} to {true_high:.2%})", "bias": "{bias:+.2%}"}
LEAST = 10_000  # below, what does not depend on N counts


@dataclass(frozen=True)
class Family:
    name: str
    parameters: tuple
    count: str  # of the row: what N is
    words: str  # of the parameter
    options: tuple = ()
    tessellation: bool = False  # of which the true error is told


FAMILIES = (
    Family("detail", (20, 45, 80, 141, 250, 400), "leaves", "boxes a side"),
    Family("accuracy", (1e-4, 1e-5, 3e-6, 1e-6, 3e-7, 1e-7), "leaves", "block error"),
    Family("picture", (64, 128, 256, 512, 1024), "elements", "pixels a side"),
    Family("tessellation", (1, 4, 16, 64), "faces", "times as many triangles", TESSELLATED, True),
    Family("tessellation-one-sided", (1, 4, 16, 64), "faces", "times as many triangles",
           (*TESSELLATED, "--exchange", "rays", "--sides", "one"), True),
)


def problem_of(family, parameter, folder):
    """What fluxel solves, and how."""
    if family.tessellation:
        room = folder / "carved-room.obj"
        write_carved_room(room, parameter)
        return room, *family.options
    if family.name == "detail":
        field = folder / "field.obj"
        write_field(field, parameter)
        return field, "--sides", "one", "--subdivision", "transport", "--block-error", "1e-3"
    if family.name == "accuracy":
        return CORNELL, "--subdivision", "transport", "--resolution", "16x16", "--block-error", str(parameter)
    return CORNELL, "--subdivision", "camera", "--resolution", f"{parameter}x{parameter}", "--block-error", "1e-4"


def measure(family, parameter, arguments):
    """Solves; a row of the table."""
    with tempfile.TemporaryDirectory(prefix="fluxel-growth-") as name:
        folder = Path(name)
        scene, *options = problem_of(family, parameter, folder)
        fluxel("solve", scene, "--method", "hierarchical", *options, "--supersample", 1, "--threads", 1, "--out", folder / "out", expect=(0, 3))
        report = load(folder / "out" / "report.json")
        true = true_error(parameter, scene, folder, arguments) if family.tessellation else {}
    hierarchy, cpu = report["hierarchy"], report["cpu_s"]
    rounds = hierarchy["rounds"]
    last = rounds[-1]
    row = {"family": family.name, "parameter": parameter, "leaves": last["leaves"], "links": last["links"],
           "pairs": hierarchy["node_pairs_looked_at"], "rays": hierarchy["rays"], "gather_rays": hierarchy["gather_rays"],
           "cpu_s": cpu["total"], "load_cpu_s": cpu["load"], "solve_cpu_s": cpu["solve"], "gather_cpu_s": cpu["gather"],
           "bytes_max": hierarchy["bytes_max"], "peak_rss": report["memory"]["peak_rss_bytes_max"],
           "faces": report["scene"]["faces_read"], "pieces": report["scene"]["pieces"], "exchange": hierarchy["exchange"],
           "rows": last["rows"], "rounds": len(rounds), "refine_s": sum(of["refine_s"] for of in rounds),
           "iterate_s": sum(of["solve_s"] for of in rounds),
           "two_rounds_s": sum(of["refine_s"] + of["solve_s"] for of in rounds[:2]),
           "audit_s": report.get("audit", {}).get("seconds"),
           "stated": report.get("stated_error"), "reached": hierarchy.get("reached"), **true}
    return row | {"n": report["elements"] if family.count == "elements" else row[family.count]}


def true_error(parameter, scene, folder, arguments):
    reference = reference_of(f"carved-room-{parameter}", scene, TESSELLATED[2:], arguments.reference_error,
                             arguments.reference_seconds, arguments.reference_threads)
    found = compare(folder / "out" / "image.exr", reference / "reference.exr", folder / "compare")
    return {"true": found["error"], "true_low": found["low"], "true_high": found["high"], "bias": found["bias"]}


def exponent(rows, what):
    """Of the power of N that fits best; None for fewer than two sizes."""
    rows = [row for row in rows if row["n"] >= LEAST and row[what] > 0]
    if len(rows) < 2:
        return None
    return numpy.polyfit(numpy.log([row["n"] for row in rows]), numpy.log([row[what] for row in rows]), 1)[0]


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


def print_tessellations(rows):
    tessellations = [family.name for family in FAMILIES if family.tessellation]
    rows = [row for row in rows if row["family"] in tessellations]
    if not rows:
        return
    print("\n| " + " | ".join(COLUMNS) + " |\n" + "| --- " * len(COLUMNS) + "|")
    for row in rows:
        print("| " + " | ".join(COLUMNS.values()).format_map(row) + " |")
    print()
    for name in tessellations:
        size = {row["parameter"]: row for row in rows if row["family"] == name}
        if not {FROM, TO} <= size.keys():
            continue
        for words, parts in (("refinement and iterations", ("refine_s", "iterate_s")),
                             ("of the first two rounds", ("two_rounds_s",)),
                             ("processor time of all rounds", ("solve_cpu_s",))):
            before, after = (sum(size[times][part] for part in parts) for times in (FROM, TO))
            print(f"{name}: {words} {before:.2f} s at {FROM} times, {after:.2f} s at {TO} times: {after / before:.2f} times")


def draw(path, rows):
    figure, panels = pyplot.subplots(1, 3, figsize=(12, 4.2), layout="constrained")
    panes = (("cpu_s", "processor time [s]", 1.0), ("peak_rss", "peak memory [MB]", 1e-6), ("links", "links", 1.0))
    for axes, (what, label, scale) in zip(panels, panes):
        axes.set(xscale="log", yscale="log", xlabel="N: leaves, elements of the picture, or faces", ylabel=label)
        for family, colour, marker in zip(FAMILIES, COLOURS, "os^DvP"):
            of_family = sorted((row for row in rows if row["family"] == family.name and row[what] > 0),
                               key=lambda row: row["n"])
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
    parser.add_argument("--reference-error", type=float, default=0.02, help="of a tessellation's reference, over the mean")
    parser.add_argument("--reference-seconds", type=float, default=600, help="that each of them may take")
    parser.add_argument("--reference-threads", type=int, default=os.cpu_count())
    arguments = parser.parse_args()

    rows = [row for row in read_rows(arguments.csv, FIELDS) if row["family"] not in arguments.families]
    for family in FAMILIES:
        if family.name not in arguments.families:
            continue
        before = None
        for parameter in family.parameters:
            # As it has grown by the last step, so by the next.
            if before is not None and before[1] * max(1.0, before[1] / before[0]) > arguments.most:
                break
            row = measure(family, parameter, arguments)
            before = (before[1] if before else row["n"], row["n"])
            rows.append(row)
            write_rows(arguments.csv, FIELDS, rows)
            print(f"{family.name}: {family.words} {parameter:g}, N = {row['n']:,}, {row['links']:,} links, "
                  f"{row['cpu_s']:.2f} s, {row['peak_rss'] / 1e6:.0f} MB", flush=True)
    print_exponents(rows)
    print_tessellations(rows)
    if arguments.image:
        draw(arguments.image, rows)


if __name__ == "__main__":
    main()
