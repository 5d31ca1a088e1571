#!/usr/bin/env python3
"""Stated and true errors of random rooms.

    source scripts/mpi-env.sh; bench/calibration/calibrate.py --seeds 1:200 --out bench/results/calibration
        [--targets 0.05 0.02 0.01] [--methods hierarchical matrix] [--pixels 48] [--kinds blinds ...]

solves the room of each seed (random_rooms.py), compares its picture with paths of light, and writes calibration.csv, a row
a run as it ends: rows that are there are not made again. Then a summary is printed and written as calibration.md. The true
error is the root mean square over the mean, of the worst colour, with the reference's noise taken out. References are kept
in build/references. Needs build/release (scripts/build).
"""

import argparse
import csv
import math
import os
import statistics
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "bench/accuracy"))

from random_rooms import KINDS, make_room
from runs import compare, fluxel, load

FIELDS = ("seed", "kind", "lamp", "faces", "method", "target", "stated", "reached", "true", "true_low", "true_high",
          "bias", "reference_noise", "defect", "warnings", "exit", "cpu_s", "wall_s")
METHODS = ("hierarchical", "matrix")


def arguments_of(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seeds", required=True, help="FIRST:LAST, both of them too")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--targets", type=float, nargs="+", default=(0.05, 0.02, 0.01))
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=METHODS)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS, help="of rooms")
    parser.add_argument("--pixels", type=int, default=48, help="in a row")
    parser.add_argument("--reference-error", type=float, default=0.02, help="standard error of a pixel, over the mean")
    parser.add_argument("--reference-seconds", type=float, default=120)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    return parser.parse_args(argv)


def reference_of(seed, file, options, arguments):
    folder = ROOT / "build/references" / f"room-{seed}-{arguments.pixels}-{arguments.reference_error:g}"
    if not (folder / "reference.json").exists():
        fluxel("reference", file, "--only", "picture", "--supersample", 1, "--target-error", arguments.reference_error,
               "--time", arguments.reference_seconds, "--threads", arguments.threads, "--out", folder, *options,
               expect=(0, 3))
    return folder / "reference.exr"


def stated_error(report):
    if report["options"]["method"] == "hierarchical":
        return math.hypot(*(error or 0 for error in report["hierarchy"]["errors"].values()))
    estimate = report.get("error_estimate", {})
    if "discretisation_rgb" not in estimate:
        return None
    return math.hypot(max(estimate["discretisation_rgb"]), max(estimate["convergence_rgb"]))


def measure(seed, room, file, method, target, reference, arguments):
    """Of a matrix there is one run, whatever the targets."""
    with tempfile.TemporaryDirectory() as folder:
        goal = ("--target-error", target) if method == "hierarchical" else ()
        code = fluxel("solve", file, "--method", method, *goal, *room.options(arguments.pixels), "--threads",
                      arguments.threads, "--out", folder, expect=(0, 3))
        report = load(Path(folder) / "report.json")
        true = compare(Path(folder) / "image.exr", reference, folder)
    return {"seed": seed, "kind": room.kind, "lamp": room.lamp, "faces": len(room.faces), "method": method,
            "target": target or "", "stated": stated_error(report),
            "reached": report["hierarchy"]["reached"] if method == "hierarchical" else "", "true": true["error"],
            "true_low": true["low"], "true_high": true["high"], "bias": true["bias"], "reference_noise": true["noise"],
            "defect": max(map(abs, report["energy"]["defect"])) / max(report["energy"]["emitted"]),
            "warnings": len(report["warnings"]), "exit": code, "cpu_s": report["cpu_s"]["total"],
            "wall_s": report["time_s"]["total"]}


def read_rows(path):
    if not path.exists():
        return []
    with open(path, newline="", encoding="utf-8") as file:
        return [{key: number_of(value) for key, value in row.items()} for row in csv.DictReader(file)]


def number_of(text):
    try:
        return float(text)
    except ValueError:
        return text


def key_of(row):
    return (float(row["seed"]), row["method"], row["target"] if row["target"] == "" else float(row["target"]))


def share(values):
    values = list(values)
    return f"{sum(values) / len(values):.0%}" if values else "-"


def summary(rows):
    """Markdown: a line for each method and target, and one for each kind of room."""
    lines = ["| rooms | runs | true at most stated | at most 1.5 times | true / stated, median | bias below half the target "
             "| reached and true | median time |", "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"]

    def add(name, some):
        told = [row for row in some if row["stated"] not in ("", None)]
        reached = [row for row in some if row["reached"] in ("True", True)]
        ratios = [row["true"] / row["stated"] for row in told]
        lines.append(
            f"| {name} | {len(some)} | {share(ratio <= 1 for ratio in ratios)} | {share(ratio <= 1.5 for ratio in ratios)} | "
            f"{f'{statistics.median(ratios):.2f}' if ratios else '-'} | "
            f"{share(abs(row['bias']) < 0.5 * row['target'] for row in some if row['target'] != '')} | "
            f"{share(row['true_low'] <= row['target'] for row in reached)} of {len(reached)} | "
            f"{statistics.median(row['cpu_s'] for row in some):.2f} s |")

    for method, target in sorted({(row["method"], row["target"]) for row in rows}, key=str):
        some = [row for row in rows if (row["method"], row["target"]) == (method, target)]
        add(f"{method}{f', {target:.0%}' if target != '' else ''}", some)
    for method in sorted({row["method"] for row in rows}):
        for kind in sorted({row["kind"] for row in rows}):
            some = [row for row in rows if (row["method"], row["kind"]) == (method, kind)]
            if some:
                add(f"{method}, {kind}", some)
    return "\n".join(lines) + "\n"


def main(argv=None):
    arguments = arguments_of(argv)
    first, last = map(int, arguments.seeds.split(":"))
    arguments.out.mkdir(parents=True, exist_ok=True)
    table = arguments.out / "calibration.csv"
    rows = read_rows(table)
    known = set(map(key_of, rows))
    with open(table, "a", newline="", encoding="utf-8") as file, tempfile.TemporaryDirectory() as folder:
        writer = csv.DictWriter(file, FIELDS)
        if file.tell() == 0:
            writer.writeheader()
        for seed in range(first, last + 1):
            room = make_room(seed)
            if room.kind not in arguments.kinds:
                continue
            obj = Path(folder) / f"room-{seed}.obj"
            room.write(obj)
            for method in arguments.methods:
                for target in arguments.targets if method == "hierarchical" else ("",):
                    if (float(seed), method, target) in known:
                        continue
                    reference = reference_of(seed, obj, room.options(arguments.pixels), arguments)
                    row = measure(seed, room, obj, method, target, reference, arguments)
                    writer.writerow(row)
                    file.flush()
                    rows.append(row)
                    print(f"{seed} {room.kind}, {room.lamp}; {method} {target}: stated "
                          f"{row['stated'] if row['stated'] is None else format(row['stated'], '.2%')}, true "
                          f"{row['true']:.2%} ({row['true_low']:.2%} to {row['true_high']:.2%}), bias {row['bias']:+.2%}, "
                          f"{row['cpu_s']:.1f} s", flush=True)
    text = summary(rows)
    (arguments.out / "calibration.md").write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
