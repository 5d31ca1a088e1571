#!/usr/bin/env python3
"""Chart and tables of the row kernel's rates.

    solver_bench kernel --out kernel.csv
    chart.py --kernel kernel.csv --out charts --tables tables

writes charts/kernel.png and, where asked, a Markdown table (tables/kernel.md). Needs matplotlib.
"""

import argparse
import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

# Okabe & Ito's palette, told apart with any colour vision.
BARS = [("kernel", "kernel", "#0072B2"), ("loop_same_set", "plain loop, this set", "#E69F00"),
        ("loop", "plain loop, as built", "#7F7F7F"),
        ("loop_by_shifts", "the same, bits by shifts", "#CC79A7")]
RULES = ["point", "disc", "moments"]


def read(path):
    with open(path, newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def select(rows, **wanted):
    return [row for row in rows if all(row[key] == value for key, value in wanted.items())]


def draw(rows, path):
    """A panel for each instruction set, a group of bars for each rule; one side, RGB, half the bits, flat tiles."""
    sets = list(dict.fromkeys(row["isa"] for row in rows))
    figure, panels = pyplot.subplots(1, len(sets), figsize=(3.5 * len(sets) + 0.6, 3.6), sharey=True,
                                     squeeze=False, layout="constrained")
    width = 0.2
    for axes, isa in zip(panels[0], sets):
        of_set = select(rows, isa=isa, sides="one", channels="3", visible="half", tiles="planes")
        shown = [select(of_set, rule=rule)[0] for rule in RULES]
        for k, (name, label, colour) in enumerate(BARS):
            places = [group + (k - 1.5) * width for group in range(len(RULES))]
            heights = [1e-9 * float(row[name]) for row in shown]
            bars = axes.bar(places, heights, width, color=colour, label=label)
            axes.bar_label(bars, fmt="%.2g", fontsize=7, padding=1)
        for group, row in enumerate(shown):
            bound = 1e-9 * float(row["bound"])
            axes.plot([group - 2 * width, group + 2 * width], [bound, bound], color="black", linewidth=1.2,
                      label="multipliers' bound" if group == 0 else None)
        axes.set_xticks(range(len(RULES)), RULES)
        axes.set_title(isa, fontsize=10, loc="left")
        axes.grid(axis="y", color="#D9D9D9", linewidth=0.6)
        axes.set_axisbelow(True)
    panels[0][0].set_ylabel("10⁹ pairs a second, one core")
    panels[0][-1].legend(fontsize=8, frameon=False, loc="upper right")
    figure.savefig(path, dpi=90)
    pyplot.close(figure)


def write_table(rows, path):
    heads = ["set", "rule", "sides", "channels", "kernel", "loop by shifts", "loop", "loop, this set",
             "kernel / by shifts", "/ loop", "/ this set", "bound", "kernel / bound"]
    with open(path, "w", encoding="utf-8") as file:
        file.write("| " + " | ".join(heads) + " |\n| --- | --- | ---" + " | ---:" * (len(heads) - 3) + " |\n")
        for row in rows:
            loops = ("loop_by_shifts", "loop", "loop_same_set")
            rates = [f"{1e-9 * float(row[name]):.2f}" for name in ("kernel", *loops)]
            ratios = [f"{float(row['over_' + name]):.1f}" for name in loops]
            cells = [row["isa"], row["rule"], row["sides"], row["channels"], *rates, *ratios,
                     f"{1e-9 * float(row['bound']):.2f}", f"{float(row['of_bound']):.0%}"]
            file.write("| " + " | ".join(cells) + " |\n")


def main():
    parser = argparse.ArgumentParser(description="Chart and tables of the row kernel's rates.")
    parser.add_argument("--kernel", required=True, help="CSV of solver_bench kernel")
    parser.add_argument("--out", required=True, type=pathlib.Path, help="folder of the chart")
    parser.add_argument("--tables", type=pathlib.Path, help="folder of the table; none without")
    arguments = parser.parse_args()
    for folder in filter(None, (arguments.out, arguments.tables)):
        folder.mkdir(parents=True, exist_ok=True)
    rows = read(arguments.kernel)
    draw(rows, arguments.out / "kernel.png")
    if arguments.tables:
        for visible, tiles in dict.fromkeys((row["visible"], row["tiles"]) for row in rows):
            write_table(select(rows, visible=visible, tiles=tiles),
                        arguments.tables / f"kernel-{visible}-{tiles}.md")


if __name__ == "__main__":
    main()
