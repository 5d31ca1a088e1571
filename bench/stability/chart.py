#!/usr/bin/env python3
"""Charts and tables of the stability lab.

    stability_lab --out lab.csv
    chart.py lab.csv --out charts --tables tables

writes a chart (charts/NAME.png) and, where asked, a Markdown table (tables/NAME.md) of each situation. Needs
numpy and matplotlib.
"""

import argparse
import csv
import dataclasses
import math
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot
import numpy

# Okabe & Ito's palette, told apart with any colour vision; yellow is left out, too pale on white.
COLOURS = ["#D55E00", "#E69F00", "#CC79A7", "#0072B2", "#009E73", "#56B4E9", "#000000", "#7F7F7F"]
MARKERS = ["o", "s", "^", "D", "v", "P", "*", "X"]
LINES = ["-", "-", "-", "-", "--", ":", "-.", "--"]


@dataclasses.dataclass
class Situation:
    name: str
    title: str
    parameter: str
    error: str
    threshold: float
    log_parameter: bool
    curves: dict[str, list[tuple[float, float, bool]]]  # method: (value, error, converged)


def read(path):
    situations = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            situation = situations.setdefault(row["situation"], Situation(
                row["situation"], row["title"], row["parameter"], row["error_label"], float(row["threshold"]),
                row["log_parameter"] == "1", {}))
            point = float(row["value"]), float(row["error"]), row["converged"] == "1"
            situation.curves.setdefault(row["method"], []).append(point)
    return list(situations.values())


def stayed(point):
    """Whether the method has given an answer."""
    return point[2] and math.isfinite(point[1])


def answers(situation):
    return [point[1] for curve in situation.curves.values() for point in curve if stayed(point)]


def place_of_zero(situation):
    """An error of 0 has no place on a logarithmic axis: it is drawn a decade below all others."""
    above = [error for error in answers(situation) + [situation.threshold] if error > 0]
    return 0.1 * min(above, default=1e-9)


def error_range(situation):
    zero = place_of_zero(situation)
    shown = [max(error, zero) for error in answers(situation) + [situation.threshold or 10 * zero]]
    return 10 ** (math.log10(min(shown)) - 0.4), 10 ** (math.log10(max(shown)) + 0.4)


def draw_safe_region(axes, situation, low):
    top = situation.threshold or math.sqrt(10) * place_of_zero(situation)
    axes.axhspan(low, top, color="#009E73", alpha=0.10, linewidth=0)
    axes.axhline(top, color="#4D4D4D", linewidth=1)
    label = f"safe up to {situation.threshold:g}" if situation.threshold else "safe: 0"
    axes.annotate(label, (1, top), (6, 0), xycoords=("axes fraction", "data"), textcoords="offset points",
                  va="center", fontsize=8, color="#4D4D4D", annotation_clip=False)


def draw(situation, path):
    figure, axes = pyplot.subplots(figsize=(8, 4.6), layout="constrained")
    axes.set_yscale("log")
    low, high = error_range(situation)
    zero = place_of_zero(situation)
    lost_curves = sum(any(not stayed(point) for point in curve) for curve in situation.curves.values())
    rows = 10 ** (0.05 * math.log10(high / low))  # between the rows of crosses along the top
    axes.set_ylim(low, high * rows ** (lost_curves + (lost_curves > 0)))
    draw_safe_region(axes, situation, low)
    row = 0
    for number, (method, curve) in enumerate(situation.curves.items()):
        style = dict(color=COLOURS[number % len(COLOURS)], marker=MARKERS[number % len(MARKERS)])
        places = numpy.array([point[0] for point in curve])
        errors = numpy.array([max(point[1], zero) if stayed(point) else numpy.nan for point in curve])
        # Curves that lie on each other: the later one is smaller and the one below shows around it.
        axes.plot(places, errors, label=method, linestyle=LINES[number % len(LINES)], linewidth=1.5,
                  markersize=8 - 0.7 * number, **style)
        lost = places[numpy.isnan(errors)]
        if lost.size:
            row += 1
            axes.plot(lost, numpy.full(lost.size, high * rows ** row), linestyle="", marker="x", markersize=7,
                      markeredgewidth=2, color=style["color"])
    if row:
        axes.plot([], [], linestyle="", marker="x", color="#4D4D4D", label="no solution")
    set_parameter_axis(axes, situation)
    without_error = min(answers(situation), default=1) <= 0
    axes.set_ylabel(situation.error + (f" (0 stands at {zero:.0e})" if without_error else ""))
    axes.set_title(situation.title, fontsize=11, loc="left")
    axes.grid(which="major", color="#D9D9D9", linewidth=0.6)
    axes.set_axisbelow(True)
    place_legend(axes, situation)
    figure.savefig(path, dpi=80)
    pyplot.close(figure)


def place_legend(axes, situation):
    """Beside the chart, in the half that the threshold's label leaves free."""
    low, high = numpy.log10(axes.get_ylim())
    top = situation.threshold == 0 or math.log10(situation.threshold) < 0.5 * (low + high)
    axes.legend(loc="upper left" if top else "lower left", bbox_to_anchor=(1.01, 1.0 if top else 0.0),
                borderaxespad=0, fontsize=9, frameon=False)


def set_parameter_axis(axes, situation):
    axes.set_xlabel(situation.parameter)
    if not situation.log_parameter:
        return
    values = sorted({point[0] for curve in situation.curves.values() for point in curve})
    if values[0] <= 0:
        axes.set_xscale("symlog", linthresh=min(value for value in values if value > 0))
        return
    axes.set_xscale("log")
    if len(values) <= 12 and values[-1] / values[0] <= 1000:
        ticks = [values[0]]
        for value in values[1:]:  # labels need room
            if math.log(value / ticks[-1]) > 0.05 * math.log(values[-1] / values[0]):
                ticks.append(value)
        axes.set_xticks(ticks, [f"{value:g}" for value in ticks])
        axes.set_xticks([], minor=True)


def write_table(situation, path):
    methods = list(situation.curves)
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"{situation.title}: {situation.error}; safe up to {situation.threshold:g} (bold).\n\n")
        file.write(f"| {situation.parameter} | " + " | ".join(methods) + " |\n")
        file.write("| ---: |" + " ---: |" * len(methods) + "\n")
        for points in zip(*situation.curves.values()):
            cells = [f"{points[0][0]:g}"] + [cell(point, situation) for point in points]
            file.write("| " + " | ".join(cells) + " |\n")


def cell(point, situation):
    if not stayed(point):
        return "no solution"
    text = f"{point[1]:.2g}"
    return f"**{text}**" if point[1] <= situation.threshold else text


def main():
    parser = argparse.ArgumentParser(description="Charts and tables of the stability lab.")
    parser.add_argument("table", help="CSV of stability_lab")
    parser.add_argument("--out", required=True, type=pathlib.Path, help="folder of the charts")
    parser.add_argument("--tables", type=pathlib.Path, help="folder of the tables; none without")
    arguments = parser.parse_args()
    for folder in filter(None, (arguments.out, arguments.tables)):
        folder.mkdir(parents=True, exist_ok=True)
    for situation in read(arguments.table):
        draw(situation, arguments.out / f"{situation.name}.png")
        if arguments.tables:
            write_table(situation, arguments.tables / f"{situation.name}.md")
        print(situation.name)


if __name__ == "__main__":
    main()
