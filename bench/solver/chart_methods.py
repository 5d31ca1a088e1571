#!/usr/bin/env python3
"""Charts and tables of the solvers.

    solver_bench methods --out methods.csv
    chart_methods.py methods.csv --out charts --markdown methods.md

writes charts/iterations.png and charts/seconds.png, of the solves to 1e-3, and where asked Markdown tables of
all. Needs matplotlib.
"""

import argparse
import csv
import pathlib

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

# Okabe & Ito's palette, told apart with any colour vision.
STYLES = {"Jacobi": ("#D55E00", "o"), "Gauss-Seidel": ("#CC79A7", "s"), "Southwell": ("#0072B2", "^"),
          "CG": ("#009E73", "D")}
ROOMS = {"box": "convex box", "cluttered": "cluttered room", "two-rooms": "two rooms, small door"}
REFLECTANCES = ["0.5", "0.8", "0.9", "0.99", "0.999", "mixed"]
PLACES = {name: place + 0.4 * (name == "mixed") for place, name in enumerate(REFLECTANCES)}


def read(path):
    """(room, start, reflectance, tolerance, solver): its row."""
    rows = {}
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            key = row["room"], row["start"], row["reflectance"], float(row["tolerance"]), row["solver"]
            rows[key] = row
    return rows


def rooms_of(rows):
    return [room for room in ROOMS if any(key[0] == room for key in rows)]


def elements_of(rows, room):
    return next(int(row["elements"]) for key, row in rows.items() if key[0] == room)


def draw(rows, column, label, path):
    rooms = rooms_of(rows)
    figure, panels = pyplot.subplots(1, len(rooms), figsize=(4.1 * len(rooms), 4.2), sharey=True,
                                     layout="constrained", squeeze=False)
    for axes, room in zip(panels[0], rooms):
        for solver, (colour, marker) in STYLES.items():
            found = [(PLACES[name], rows[key]) for name in REFLECTANCES
                     if (key := (room, "cold", name, 1e-3, solver)) in rows]
            line = [(place, float(row[column])) for place, row in found if row["reflectance"] != "mixed"]
            axes.plot(*zip(*line), color=colour, linewidth=1.5)
            for place, row in found:
                done = row["outcome"] == "converged"
                axes.plot(place, float(row[column]), marker, color=colour, markersize=6,
                          markerfacecolor=colour if done else "white")
        axes.axvline(PLACES["mixed"] - 0.7, color="#B0B0B0", linewidth=0.8)
        axes.set_yscale("log")
        axes.set_xticks(list(PLACES.values()), list(PLACES))
        axes.set_xlabel("reflectance")
        axes.set_title(f"{ROOMS[room]}, {elements_of(rows, room):,} elements", fontsize=10, loc="left")
        axes.grid(which="major", color="#D9D9D9", linewidth=0.6)
        axes.set_axisbelow(True)
    panels[0][0].set_ylabel(label)
    handles = [matplotlib.lines.Line2D([], [], color=colour, marker=marker, label=solver)
               for solver, (colour, marker) in STYLES.items()]
    handles.append(matplotlib.lines.Line2D([], [], color="#4D4D4D", marker="o", markerfacecolor="white",
                                           linestyle="", label="given up"))
    panels[0][0].legend(handles=handles, fontsize=9, frameon=False, loc="upper left")
    figure.savefig(path, dpi=90)
    pyplot.close(figure)


def cell(row):
    if row is None or row["outcome"] == "time":
        return "-"
    text = f"{int(row['iterations'])}, {float(row['seconds']):.2f} s"
    return text if row["outcome"] == "converged" else f"- ({float(row['bound']):.1g})"


def ratio(rows, key):
    """Seconds of conjugate gradients over Jacobi's."""
    mine, other = rows.get((*key, "CG")), rows.get((*key, "Jacobi"))
    if None in (mine, other) or mine["outcome"] != "converged" or other["outcome"] == "rounding":
        return "-"
    less = "< " if other["outcome"] == "time" else ""
    return f"{less}{float(mine['seconds']) / float(other['seconds']):.2g}"


def write_table(rows, keys, file):
    file.write("| room | rho | F for the bound | " + " | ".join(STYLES) + " | CG : Jacobi |\n")
    file.write("| --- | --- | ---: |" + " ---: |" * (len(STYLES) + 1) + "\n")
    for key in keys:
        found = [rows.get((*key, solver)) for solver in STYLES]
        if not any(found):
            continue
        weights = next(row for row in found if row)
        name = key[2] if key[1] == "cold" else f"{key[2]}, {key[1]}"
        file.write(f"| {key[0]} | {name} | {weights['weight-applications']}, "
                   f"{float(weights['weight-seconds']):.2f} s | " + " | ".join(map(cell, found))
                   + f" | {ratio(rows, key)} |\n")


def write_tables(rows, path):
    rooms = rooms_of(rows)
    starts = "cold", "other colour", "other place"
    with open(path, "w", encoding="utf-8") as file:
        for tolerance in (1e-3, 1e-6):
            file.write(f"To {tolerance:g}:\n\n")
            keys = [(room, "cold", rho, tolerance) for room in rooms for rho in REFLECTANCES]
            write_table(rows, keys, file)
            file.write("\n")
        file.write("From another solution, to 0.001:\n\n")
        write_table(rows, [(room, start, "0.8", 1e-3) for room in rooms for start in starts], file)


def main():
    parser = argparse.ArgumentParser(description="Charts and tables of the solvers.")
    parser.add_argument("table", help="CSV of solver_bench methods")
    parser.add_argument("--out", required=True, type=pathlib.Path, help="folder of the charts")
    parser.add_argument("--markdown", type=pathlib.Path, help="Markdown file; none without")
    arguments = parser.parse_args()
    rows = read(arguments.table)
    arguments.out.mkdir(parents=True, exist_ok=True)
    draw(rows, "iterations", "iterations to 1e-3", arguments.out / "iterations.png")
    draw(rows, "seconds", "processor seconds to 1e-3", arguments.out / "seconds.png")
    if arguments.markdown:
        write_tables(rows, arguments.markdown)


if __name__ == "__main__":
    main()
