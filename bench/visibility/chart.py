#!/usr/bin/env python3
"""Charts and tables of the visibility benchmark.

    visibility_bench visibility --out visibility.csv
    visibility_bench subdivision --out subdivision.csv
    chart.py --visibility visibility.csv --subdivision subdivision.csv --out charts --tables tables

writes charts/NAME.png and, where asked, Markdown tables (tables/NAME.md): ratio, speed, growth (Debelov &
Sattarov, Fig. 4) from the one table, subdivision (their Fig. 3) from the other. Needs numpy and matplotlib.
"""

import argparse
import csv
import math
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot
import numpy

# Okabe & Ito's palette, told apart with any colour vision; yellow is left out, too pale on white.
COLOURS = ["#D55E00", "#0072B2", "#009E73", "#E69F00", "#CC79A7", "#56B4E9", "#000000", "#7F7F7F", "#8B4513"]
MARKERS = ["o", "s", "^", "D", "v", "P", "*", "X", "<"]


def read(path):
    """scene: its rows, numbers as numbers, in the order of the file."""
    scenes = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            numbers = {key: float(value) for key, value in row.items() if key != "scene"}
            scenes.setdefault(row["scene"], []).append(numbers)
    return scenes


def fit(x, y):
    """(factor, power) of y = factor x^power by least squares in log-log; None where there is one x alone."""
    if len(set(x)) < 2:
        return None
    power, logarithm = numpy.polyfit(numpy.log(x), numpy.log(y), 1)
    return math.exp(logarithm), power


def column(rows, name):
    return numpy.array([row[name] for row in rows])


def new_axes(x_label, y_label, title):
    figure, axes = pyplot.subplots(figsize=(8, 4.6), layout="constrained")
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    axes.set_title(title, fontsize=11, loc="left")
    axes.set_xscale("log")
    axes.grid(which="major", color="#D9D9D9", linewidth=0.6)
    axes.set_axisbelow(True)
    return figure, axes


def finish(figure, axes, path):
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1), borderaxespad=0, fontsize=9, frameon=False)
    figure.savefig(path, dpi=80)
    pyplot.close(figure)


def style(number):
    return {"color": COLOURS[number % len(COLOURS)], "marker": MARKERS[number % len(MARKERS)]}


def draw_against_size(scenes, name, scale, y_label, title, path):
    figure, axes = new_axes("elements N", y_label, title)
    for number, (scene, rows) in enumerate(scenes.items()):
        axes.plot(column(rows, "elements"), scale * column(rows, name), label=scene, **style(number))
    axes.set_ylim(bottom=0)
    finish(figure, axes, path)


def draw_fitted(axes, x, y, label, variable, line, fill, number):
    """Points with the line fitted through them, which the legend names."""
    law = fit(x, y)
    if law:
        ends = numpy.array([x.min(), x.max()])
        axes.plot(ends, law[0] * ends ** law[1], linestyle=line, linewidth=1.3, color=style(number)["color"])
        label += f": {variable}$^{{{law[1]:.2f}}}$"
    axes.plot(x, y, linestyle="", markerfacecolor=style(number)["color"] if fill else "white", label=label,
              **style(number))


def draw_growth(scenes, path):
    """A panel for each scene of several sizes, since curves that differ by a little would hide each other."""
    scenes = {scene: rows for scene, rows in scenes.items() if len(rows) > 1}
    if not scenes:
        return
    across = min(3, len(scenes))
    down = math.ceil(len(scenes) / across)
    figure, panels = pyplot.subplots(down, across, figsize=(3.2 * across, 2.7 * down), layout="constrained",
                                     sharex=True, sharey=True, squeeze=False)
    for axes, (scene, rows) in zip(panels.flat, scenes.items()):
        axes.loglog()
        axes.set_title(scene, fontsize=10, loc="left")
        axes.grid(which="major", color="#D9D9D9", linewidth=0.6)
        size, classical = column(rows, "elements"), column(rows, "classical_seconds")
        if (classical > 0).all():
            draw_fitted(axes, size, classical, "elements occlude", "N", "--", False, 0)
        draw_fitted(axes, size, column(rows, "seconds"), "patches occlude", "N", "-", True, 1)
        axes.legend(fontsize=8, frameon=False, loc="upper left")
        axes.tick_params(labelbottom=True)
    for axes in panels.flat[len(scenes):]:
        axes.remove()
    figure.supxlabel("elements N", fontsize=10)
    figure.supylabel("time of the visibility matrix on one core [s]", fontsize=10)
    figure.savefig(path, dpi=80)
    pyplot.close(figure)


def draw_subdivision(scenes, path):
    figure, axes = new_axes("pixels a side R", "time on one core [s]", "Time of camera subdivision")
    axes.set_yscale("log")
    for number, (scene, rows) in enumerate(scenes.items()):
        seconds = column(rows, "raster_seconds") + column(rows, "split_seconds")
        draw_fitted(axes, column(rows, "resolution"), seconds, scene, "R", "-", True, number)
    ticks = sorted({int(row["resolution"]) for rows in scenes.values() for row in rows})
    axes.set_xticks(ticks, [str(tick) for tick in ticks])
    axes.set_xticks([], minor=True)
    finish(figure, axes, path)


def write_table(heads, rows, path):
    with open(path, "w", encoding="utf-8") as file:
        file.write("| " + " | ".join(heads) + " |\n| ---" + " | ---:" * (len(heads) - 1) + " |\n")
        for row in rows:
            file.write("| " + " | ".join(row) + " |\n")


def write_visibility_table(scenes, path):
    heads = ["scene", "N", "time [s]", "million pairs/s", "million rays/s", "raw million rays/s", "ratio",
             "tiles without rays", "tiles of one value", "bits a pair", "8 x 8 mixed", "4 x 4 mixed"]
    def cells(scene, row):
        sampled = "" if row["traced_tiles"] == row["tiles"] else " (sample)"
        rates = [row[name] * 1e-6 for name in ("pairs_per_second", "rays_per_second", "raw_rays_per_second")]
        shares = [row[name] for name in ("without_rays", "one_value")]
        mixed = [row[name] for name in ("mixed_8", "mixed_4")]
        return [scene, f"{row['elements']:,.0f}{sampled}", f"{row['seconds']:.3g}",
                *(f"{rate:.1f}" for rate in rates), f"{row['ratio']:.2f}",
                *(f"{share:.1%}" for share in shares), f"{row['bits_a_pair']:.3f}",
                *(f"{share:.1%}" for share in mixed)]

    write_table(heads, [cells(scene, row) for scene, rows in scenes.items() for row in rows], path)


def write_growth_table(scenes, path):
    def law(rows, name):
        fitted = fit(column(rows, "elements"), column(rows, name)) if rows[0][name] > 0 else None
        return f"{fitted[0]:.2g} s N^{fitted[1]:.2f}" if fitted else "-"

    laws = [[scene, law(rows, "seconds"), law(rows, "classical_seconds")] for scene, rows in scenes.items()]
    write_table(["scene", "patches occlude", "elements occlude"], laws, path)


def write_subdivision_table(scenes, path):
    write_table(["scene", "resolution", "elements", "raster [s]", "splitting [s]"], [
        [scene, "{0:.0f} x {0:.0f}".format(row["resolution"]), f"{row['elements']:,.0f}",
         f"{row['raster_seconds']:.3g}", f"{row['split_seconds']:.3g}"]
        for scene, rows in scenes.items() for row in rows], path)


def main():
    parser = argparse.ArgumentParser(description="Charts and tables of the visibility benchmark.")
    parser.add_argument("--visibility", help="CSV of visibility_bench visibility")
    parser.add_argument("--subdivision", help="CSV of visibility_bench subdivision")
    parser.add_argument("--out", required=True, type=pathlib.Path, help="folder of the charts")
    parser.add_argument("--tables", type=pathlib.Path, help="folder of the tables; none without")
    arguments = parser.parse_args()
    for folder in filter(None, (arguments.out, arguments.tables)):
        folder.mkdir(parents=True, exist_ok=True)
    if arguments.visibility:
        scenes = read(arguments.visibility)
        draw_against_size(scenes, "ratio", 1, "pairs a second / raw rays a second",
                          "Pairs of N² resolved in the time of one bare ray", arguments.out / "ratio.png")
        draw_against_size(scenes, "pairs_per_second", 1e-6, "million pairs of N² a second",
                          "Speed of the visibility engine on one core", arguments.out / "speed.png")
        draw_growth(scenes, arguments.out / "growth.png")
        if arguments.tables:
            write_visibility_table(scenes, arguments.tables / "visibility.md")
            write_growth_table(scenes, arguments.tables / "growth.md")
    if arguments.subdivision:
        scenes = read(arguments.subdivision)
        draw_subdivision(scenes, arguments.out / "subdivision.png")
        if arguments.tables:
            write_subdivision_table(scenes, arguments.tables / "subdivision.md")


if __name__ == "__main__":
    main()
