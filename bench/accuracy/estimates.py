#!/usr/bin/env python3
"""Holds each run's estimate of its error against the true error of its elements, which paths of light tell.

    bench/accuracy/estimates.py --out bench/results/accuracy

writes estimates.csv, estimates.md and the chart (estimates.png, estimates.svg). True is what `fluxel compare` says of
the solution and a reference of the same elements, the reference's noise taken out, of the worst colour. Takes about
20 minutes on 2 cores, nearly all of it references, which are kept in build/references. Needs build/release
(scripts/build), numpy and matplotlib.
"""

import argparse
import csv
import os
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import matplotlib

sys.dont_write_bytecode = True
matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

from runs import References, compare, fluxel, load
from settings import ROOT, Scene

# A ratio of estimate and truth that serves.
LOW, HIGH = 0.7, 1.5
FIELDS = ("scene", "options", "elements", "coarser", "order", "iteration_bound", "estimated", "true",
          "true_low", "true_high", "ratio")


@dataclass(frozen=True)
class Case:
    """A scene file, with options of its solve; rays that its reference takes."""

    file: str
    options: tuple
    rays: int

    @property
    def name(self):
        return Path(self.file).stem

    @property
    def scene(self):
        return Scene(self.name, ROOT / "scenes" / self.file, (), ())


def at(resolution):
    return ("--resolution", resolution)


CASES = (
    Case("cornell-box/cornell-box.toml", at("48x48"), 150_000_000),
    Case("cornell-box/cornell-box.toml", at("64x64"), 200_000_000),
    Case("emitting-wall/emitting-wall.toml", ("--max-edge", "0.126"), 150_000_000),
    Case("construction-in-wood/construction-in-wood.toml", (*at("48x48"), "--max-edge", "0.4"), 80_000_000),
    Case("room-of-boxes/room-of-12-boxes.toml", at("48x48"), 40_000_000),
    Case("courtyard/courtyard.toml", at("64x48"), 150_000_000),
    Case("office-2391/office-2391.toml", at("48x48"), 40_000_000),
)


def measure(case, references, threads):
    """Solves, and compares with the reference of the solution's elements; a row of the table, none where no estimate is made."""
    with tempfile.TemporaryDirectory(prefix="fluxel-estimates-") as folder:
        fluxel("solve", case.scene.file, "--method", "matrix", "--out", folder, "--threads", threads, *case.options)
        report = load(Path(folder) / "report.json")
        estimate = report["error_estimate"]
        if "why_none" in estimate:
            print(f"{case.name}: no estimate: {estimate['why_none']}", flush=True)
            return None
        solution = Path(folder) / "solution.ply"
        reference = references(case.rays, threads).elements(case.scene, solution, report["hash"]["elements"])
        true = compare(solution, reference / "reference.ply", Path(folder) / "compare")
    estimated = max(estimate["discretisation_rgb"])
    return {"scene": case.name, "options": " ".join(case.options), "elements": estimate["elements"][0],
            "coarser": " ".join(map(str, estimate["elements"][1:])), "order": estimate.get("order"),
            "iteration_bound": max(estimate["convergence_rgb"]), "estimated": estimated, "true": true["error"],
            "true_low": true["low"], "true_high": true["high"], "ratio": estimated / true["error"]}


def percent(value):
    return f"{100 * value:.2f} %"


def write_table(path, rows):
    columns = ("scene", "options", "elements", "coarser", "order", "iteration, at most", "estimated", "true",
               "standard error", "ratio")
    lines = [f"| {' | '.join(columns)} |", "| --- " * len(columns) + "|"]
    for row in rows:
        order = "-" if row["order"] is None else f"{row['order']:.2f}"
        lines.append(f"| {row['scene']} | `{row['options']}` | {row['elements']} | {row['coarser'].replace(' ', ', ')} "
                     f"| {order} | {percent(row['iteration_bound'])} | {percent(row['estimated'])} | "
                     f"{percent(row['true'])} | "
                     f"{percent(row['true_low'])} to {percent(row['true_high'])} | {row['ratio']:.2f} |")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def draw(folder, rows):
    figure, axes = pyplot.subplots(figsize=(6, 5.2))
    true = [100 * row["true"] for row in rows]
    estimated = [100 * row["estimated"] for row in rows]
    ends = [min(true + estimated) / 1.6, max(true + estimated) * 1.6]
    axes.fill_between(ends, [LOW * end for end in ends], [HIGH * end for end in ends], color="#56B4E9", alpha=0.25,
                      linewidth=0, label=f"{LOW} to {HIGH} times the truth")
    axes.plot(ends, ends, color="black", linewidth=0.8, label="the truth")
    whiskers = [[100 * (row["true"] - row["true_low"]) for row in rows],
                [100 * (row["true_high"] - row["true"]) for row in rows]]
    axes.errorbar(true, estimated, xerr=whiskers, fmt="o", color="#D55E00", capsize=2)
    for x, y, row in zip(true, estimated, rows):
        # Below its point, or above where it would leave the chart.
        place = {"xytext": (6, -9)} if x < ends[1] / 3 else {"xytext": (6, 6), "ha": "right"}
        axes.annotate(f"{row['scene']}, {row['elements']}", (x, y), textcoords="offset points", fontsize=8, **place)
    axes.set(xscale="log", yscale="log", xlim=ends, ylim=ends, xlabel="true error of B, % of its mean",
             ylabel="estimated error, % of the mean B")
    axes.grid(which="both", linewidth=0.3)
    axes.legend(fontsize=8)
    figure.tight_layout()
    for kind in ("png", "svg"):
        figure.savefig(folder / f"estimates.{kind}", dpi=150)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--scenes", nargs="+", help="by name")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--references", type=Path, default=ROOT / "build/references")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    rows = []
    for case in CASES:
        if not arguments.scenes or case.name in arguments.scenes:
            row = measure(case, lambda rays, threads: References(arguments.references, rays, threads),
                          arguments.threads)
            if row:
                rows.append(row)
                print(row, flush=True)
    with open(arguments.out / "estimates.csv", "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, FIELDS)
        writer.writeheader()
        writer.writerows(rows)
    write_table(arguments.out / "estimates.md", rows)
    draw(arguments.out, rows)


if __name__ == "__main__":
    main()
