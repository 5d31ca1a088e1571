#!/usr/bin/env python3
"""Charts and Markdown tables of the simulation.

    chart.py --scaling scaling.csv --weak weak.csv --tasks tasks.csv --slow slow.csv --out bench/results/scaling \\
             --tables tables.md

writes efficiency.png, saturation.png, memory.png, weak.png and tasks.png. Needs matplotlib.
"""

import argparse
import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

# Okabe & Ito's palette, told apart with any colour vision.
BLUE, ORANGE, GREEN, PINK, GREY = "#0072B2", "#E69F00", "#009E73", "#CC79A7", "#7F7F7F"
DESIGN_COLOURS = (BLUE, ORANGE, GREEN, PINK, "#D55E00")
NETWORK_LINES = {"InfiniBand": "-", "Ethernet": ":"}
AIM = 0.85


def read(path):
    """Rows with numbers where there are numbers."""
    def value(text):
        try:
            return float(text)
        except ValueError:
            return text
    with open(path, newline="", encoding="utf-8") as file:
        return [{key: value(text) for key, text in row.items()} for row in csv.DictReader(file)]


def select(rows, **wanted):
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def unique(rows, key):
    return list(dict.fromkeys(row[key] for row in rows))


def tidy(axes, title, label):
    axes.set_title(title, fontsize=10, loc="left")
    axes.set_xscale("log", base=2)
    axes.xaxis.set_major_locator(matplotlib.ticker.LogLocator(base=4))
    axes.xaxis.set_major_formatter(matplotlib.ticker.FormatStrFormatter("%g"))
    axes.set_xlabel("ranks of one thread")
    axes.set_ylabel(label)
    axes.grid(color="#D9D9D9", linewidth=0.6)
    axes.set_axisbelow(True)


def save(figure, path):
    figure.savefig(path, dpi=100)
    pyplot.close(figure)


def draw_efficiency(rows, path):
    """A row of panels for each size: visibility, solve, both; a colour for each design, a line for each network."""
    sizes = unique(rows, "elements")
    columns = (("visibility_efficiency", "visibility"), ("solve_efficiency", "solve"),
               ("efficiency", "both, 10 iterations"))
    figure, grid = pyplot.subplots(len(sizes), 3, figsize=(12, 3.6 * len(sizes)), layout="constrained", squeeze=False)
    for line, size in enumerate(sizes):
        for axes, (column, name) in zip(grid[line], columns):
            for colour, design in zip(DESIGN_COLOURS, unique(rows, "design")):
                for network, style in NETWORK_LINES.items():
                    points = select(rows, elements=size, design=design, network=network)
                    axes.plot([row["ranks"] for row in points], [row[column] for row in points], style, marker="o",
                              markersize=3, color=colour, label=f"{design}, {network}")
            axes.axhline(AIM, color=GREY, linestyle="--", linewidth=1)
            axes.set_ylim(0, 1.05)
            tidy(axes, f"{name}, N = {size:,.0f}", "efficiency over one rank")
    handles, labels = grid[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, fontsize=8, frameon=False, loc="lower center", ncols=4,
                  bbox_to_anchor=(0.5, -0.02 - 0.1 / len(sizes)))
    figure.savefig(path, dpi=100, bbox_inches="tight")
    pyplot.close(figure)


def draw_pair(rows, column, label, title, path, factor=1.0):
    """One panel, the program as it is: a colour for each size, a line for each network."""
    figure, axes = pyplot.subplots(figsize=(6, 3.8), layout="constrained")
    for colour, size in zip(DESIGN_COLOURS, unique(rows, "elements")):
        for network, style in NETWORK_LINES.items():
            points = select(rows, elements=size, design="as it is", network=network)
            axes.plot([row["ranks"] for row in points], [factor * row[column] for row in points], style, marker="o",
                      markersize=3, color=colour, label=f"N = {size:,.0f}, {network}")
    tidy(axes, title, label)
    axes.set_ylim(bottom=0)
    axes.legend(fontsize=8, frameon=False)
    save(figure, path)


def draw_weak(rows, path):
    figure, axes = pyplot.subplots(figsize=(6, 3.8), layout="constrained")
    for design, style in (("as it is", "-"), ("rows by the forecast", "--")):
        for colour, column, name in ((BLUE, "visibility_efficiency", "visibility"),
                                     (ORANGE, "solve_efficiency", "solve")):
            points = select(rows, design=design)
            axes.plot([row["ranks"] for row in points], [row[column] for row in points], style, marker="o",
                      markersize=3, color=colour, label=f"{name}, {design}")
    tidy(axes, "Weak scaling: as many pairs a rank", "efficiency over one rank")
    axes.set_ylim(0, 1.05)
    axes.legend(fontsize=8, frameon=False)
    save(figure, path)


def draw_tasks(rows, path):
    """A column of panels for each scene: messages, bytes, idle share."""
    scenes = unique(rows, "scene")
    shown = (("messages", "messages", 1.0), ("bytes", "MB sent", 1e-6), ("idle", "idle, % of all ranks' time", 100.0))
    figure, grid = pyplot.subplots(3, len(scenes), figsize=(5 * len(scenes), 9), layout="constrained", squeeze=False)
    for column, scene in enumerate(scenes):
        for axes, (name, label, factor) in zip(grid[:, column], shown):
            for task, colour in (("strip", BLUE), ("pair of patches", ORANGE)):
                points = select(rows, scene=scene, task=task)
                axes.plot([row["ranks"] for row in points], [factor * row[name] for row in points], marker="o",
                          markersize=3, color=colour, label=task)
            tidy(axes, scene, label)
            if name != "idle":
                axes.set_yscale("log")
    grid[0][0].legend(fontsize=8, frameon=False)
    save(figure, path)


def markdown(rows, columns, file):
    """`columns`: heading, text of a row."""
    file.write("| " + " | ".join(name for name, _ in columns) + " |\n")
    file.write("| --- |" + " ---: |" * (len(columns) - 1) + "\n")
    for row in rows:
        file.write("| " + " | ".join(text(row) for _, text in columns) + " |\n")
    file.write("\n")


def percent(key):
    return lambda row: f"{100 * row[key]:.1f} %"


def fixed(key, digits, factor=1.0):
    return lambda row: f"{factor * row[key]:,.{digits}f}"


SCALING_COLUMNS = [
    ("ranks", fixed("ranks", 0)), ("visibility, s", fixed("visibility_s", 3)),
    ("efficiency", fixed("visibility_efficiency", 2)), ("idle", percent("idle")),
    ("messages, of all ranks' time", percent("messages_share")), ("of rank 0's", percent("master_messages_share")),
    ("iteration, ms", fixed("iteration_s", 1, 1e3)), ("solve efficiency", fixed("solve_efficiency", 2)),
    ("both", fixed("efficiency", 2)), ("MB a rank", fixed("rank_bytes", 0, 1e-6))]


def write_tables(arguments, file):
    scaling = read(arguments.scaling)
    for size in unique(scaling, "elements"):
        for network in NETWORK_LINES:
            file.write(f"Strong scaling, N = {size:,.0f}, {network}, as it is:\n\n")
            markdown(select(scaling, elements=size, network=network, design="as it is"), SCALING_COLUMNS, file)
            most = select(scaling, elements=size, network=network, ranks=1024.0)
            if most:
                file.write("Rows by the forecast, and as it is, on 1024 ranks:\n\n")
                parts = [("rows, mean, ms", fixed("rows_mean_s", 1, 1e3)), ("largest", fixed("rows_largest_s", 1, 1e3)),
                         ("vectors", fixed("vectors_s", 2, 1e3)), ("exchange", fixed("exchange_s", 1, 1e3)), ("sums", fixed("sums_s", 1, 1e3))]
                markdown(most, [("design", lambda row: row["design"]), SCALING_COLUMNS[2], *parts,
                                *SCALING_COLUMNS[6:9]], file)
    if arguments.weak:
        weak = read(arguments.weak)
        for design in ("as it is", "rows by the forecast"):
            file.write(f"Weak scaling, {design}:\n\n")
            markdown(select(weak, design=design), [("N", fixed("elements", 0)), *SCALING_COLUMNS], file)
    if arguments.slow:
        file.write("Ranks of different speed:\n\n")
        markdown(read(arguments.slow), [("speeds", lambda row: row["speeds"]), ("N", fixed("elements", 0)),
                                        *SCALING_COLUMNS[:4]], file)
    if arguments.tasks:
        file.write("Strips and pairs of patches:\n\n")
        markdown(read(arguments.tasks),
                 [("scene", lambda row: row["scene"]), ("task", lambda row: row["task"]), *SCALING_COLUMNS[:6],
                  ("tasks", fixed("strips", 0)), ("messages", fixed("messages", 0)),
                  ("MB sent", fixed("bytes", 2, 1e-6))], file)


def main():
    parser = argparse.ArgumentParser(description="Charts and Markdown tables of the simulation.")
    parser.add_argument("--scaling", required=True, help="CSV of simulate_bench scaling")
    parser.add_argument("--weak", help="CSV of simulate_bench weak")
    parser.add_argument("--tasks", help="CSV of simulate_bench tasks")
    parser.add_argument("--slow", help="CSV of simulate_bench slow")
    parser.add_argument("--out", required=True, type=pathlib.Path, help="folder of the charts")
    parser.add_argument("--tables", type=pathlib.Path, help="Markdown file; none without")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    scaling = read(arguments.scaling)
    draw_efficiency(scaling, arguments.out / "efficiency.png")
    draw_pair(scaling, "master_messages_share", "% of rank 0's time", "Rank 0 at its messages",
              arguments.out / "saturation.png", 100.0)
    draw_pair(scaling, "rank_bytes", "MB", "Memory of the largest rank", arguments.out / "memory.png", 1e-6)
    if arguments.weak:
        draw_weak(read(arguments.weak), arguments.out / "weak.png")
    if arguments.tasks:
        draw_tasks(read(arguments.tasks), arguments.out / "tasks.png")
    if arguments.tables:
        with open(arguments.tables, "w", encoding="utf-8") as file:
            write_tables(arguments, file)


if __name__ == "__main__":
    main()
