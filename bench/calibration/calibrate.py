#!/usr/bin/env python3
"""Stated and true errors of random rooms.

    source scripts/mpi-env.sh; bench/calibration/calibrate.py --seeds 1:200 --out bench/results/calibration
        [--targets 0.05 0.02 0.01] [--methods hierarchical matrix] [--pixels 48] [--kinds blinds ...]
    bench/calibration/calibrate.py --rooms blinds hooded gap-0.99 gap-0.999 --out out/hard

solves the room of each seed (random_rooms.py) or name (hard_rooms.py), compares its picture with paths of light, and writes
calibration.csv, a row a run as it ends: rows that are there are not made again. Then a summary is printed and written as
calibration.md. Errors are of the pixels that show no lamp, over their mean, with the reference's noise taken out; the true
error is that of the worst colour, the audit's interval that of the bias of green. References are kept in build/references.
Needs build/release (scripts/build) and numpy.
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
sys.path += [str(ROOT / "bench/accuracy"), str(ROOT / "python")]

import numpy as np
from fluxel import read_picture
from hard_rooms import HARD_ROOMS
from random_rooms import KINDS, make_room
from rows import read_rows
from runs import fluxel, load, reference_of

FIELDS = ("seed", "kind", "lamp", "faces", "method", "target", "stated", "estimate", "reached", "true", "true_low",
          "true_high", "bias", "bias_error", "audit_error", "audit_low", "audit_high", "audit_bias", "audit_half", "audit_holds",
          "audit_share", "defect", "rounds", "change", "step", "rays", "warnings", "exit", "cpu_s", "wall_s")
METHODS = ("hierarchical", "matrix")


def arguments_of(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    rooms = parser.add_mutually_exclusive_group(required=True)
    rooms.add_argument("--seeds", help="FIRST:LAST, both of them too")
    rooms.add_argument("--rooms", nargs="+", choices=HARD_ROOMS, help="by name")
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--targets", type=float, nargs="+", default=(0.05, 0.02, 0.01))
    parser.add_argument("--methods", nargs="+", choices=METHODS, default=METHODS)
    parser.add_argument("--kinds", nargs="+", choices=KINDS, default=KINDS, help="of rooms")
    parser.add_argument("--pixels", type=int, default=48, help="in a row")
    parser.add_argument("--reference-error", type=float, default=0.02, help="standard error of a pixel, over the mean")
    parser.add_argument("--reference-seconds", type=float, default=120)
    parser.add_argument("--limit", type=float, help="seconds that a run may take; longer ones are ended, and their rows say so")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--check", action="store_true",
                        help="end with 1 where more than one in six errors are certainly above what was stated, or one is "
                        "1.5 times above")
    return parser.parse_args(argv)


def compare(image, reference):
    """Of the pixels that reflect: the error of the worst colour, one standard error of it down and up, and for each colour
    the bias with its standard error."""
    image, truth = read_picture(image), read_picture(reference)
    lit = image["reflectance"].max(axis=-1) > 0
    value, mean, a, b, error = (of[lit].astype(float) for of in (image.values, truth.values, truth["half_a"], truth["half_b"],
                                                                truth.error))
    products = (value - a) * (value - b)
    square, spread = products.mean(axis=0), products.std(axis=0) / math.sqrt(lit.sum())
    over = np.maximum(mean.mean(axis=0), 0.1 * mean.mean())
    root = lambda of: np.sqrt(of.clip(0)) / over
    figures = {"error": root(square), "low": root(square - spread), "high": root(square + spread),
               "bias": (value - (a + b) / 2).mean(axis=0) / over, "bias_error": np.linalg.norm(error, axis=0) / lit.sum() / over}
    red, green, blue = ({name: of[colour] for name, of in figures.items()} for colour in range(3))
    return max(red, green, blue, key=lambda of: of["error"]), green


def measure(seed, room, file, method, target, reference, arguments):
    """Of a matrix there is one run, whatever the targets."""
    row = {"seed": seed, "kind": room.kind, "lamp": room.lamp, "faces": len(room.faces), "method": method,
           "target": target or ""}
    with tempfile.TemporaryDirectory() as folder:
        goal = ("--target-error", target) if method == "hierarchical" else ()
        code = fluxel("solve", file, "--method", method, *goal, *room.options(arguments.pixels), "--supersample", 1,
                      "--threads", arguments.threads, "--out", folder, expect=(0, 3), limit=arguments.limit)
        if code is None:
            return row | {"exit": "ended", "wall_s": arguments.limit}
        report = load(Path(folder) / "report.json")
        true, green = compare(Path(folder) / "image.exr", reference)
    row |= {"stated": report.get("stated_error"), "true": true["error"], "true_low": true["low"],
            "true_high": true["high"], "bias": true["bias"], "bias_error": true["bias_error"],
            "defect": max(map(abs, report["energy"]["defect"])) / max(report["energy"]["emitted"]),
            "warnings": len(report["warnings"]), "exit": code, "cpu_s": report["cpu_s"]["total"],
            "wall_s": report["time_s"]["total"]}
    if hierarchy := report.get("hierarchy"):
        last = hierarchy["rounds"][-1]
        before = hierarchy["rounds"][-2] if "change" in last else last
        row |= {"rounds": len(hierarchy["rounds"]), "reached": hierarchy.get("reached"), "change": last.get("change"),
                "step": before["block_error"] / last["block_error"], "rays": hierarchy["errors"].get("rays"),
                "estimate": math.hypot(*hierarchy["errors"].values())}
    elif elements := report["error_estimate"].get("discretisation_rgb"):
        row["estimate"] = max(elements)
    if audit := report.get("audit"):
        told = audit["bias"][1]
        # Of the difference of two independent estimates.
        half = math.hypot(told["half_interval"], 1.96 * green["bias_error"])
        row |= {"audit_error": audit["error"]["value"], "audit_low": audit["error"]["low"],
                "audit_high": audit["error"]["high"], "audit_bias": told["bias"], "audit_half": told["half_interval"],
                "audit_holds": abs(told["bias"] - green["bias"]) <= half,
                "audit_share": audit["seconds"] / report["time_s"]["total"]}
    return row


def key_of(row):
    return (row["seed"], row["method"], row["target"])


def rooms_of(arguments):
    """(seed or name, room) of each."""
    if arguments.rooms:
        return [(name, HARD_ROOMS[name]()) for name in arguments.rooms]
    first, last = map(int, arguments.seeds.split(":"))
    rooms = [(seed, make_room(seed)) for seed in range(first, last + 1)]
    return [(seed, room) for seed, room in rooms if room.kind in arguments.kinds]


def share(values):
    values = list(values)
    return f"{sum(values) / len(values):.0%}" if values else "-"


def summary(rows):
    """Markdown: a line for each method and target, and one for each kind of room."""
    lines = ["| rooms | runs | true at most stated | at most 1.5 times | true / stated, median | bias below half the target "
             "| reached and true | the audit's interval holds | its share of the time | median time |",
             "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"]

    def add(name, all_runs):
        some = [row for row in all_runs if row["exit"] != "ended"]
        if not some:
            lines.append(f"| {name} | 0 of {len(all_runs)} |" + " - |" * 8)
            return
        told = [row for row in some if row["stated"] not in ("", None)]
        reached = [row for row in some if row["reached"] in ("True", True)]
        audited = [row for row in some if row["audit_bias"] not in ("", None)]
        ratios = [row["true"] / row["stated"] for row in told]
        lines.append(
            f"| {name} | {len(some)}{f' of {len(all_runs)}' if len(some) < len(all_runs) else ''} | {share(ratio <= 1 for ratio in ratios)} | {share(ratio <= 1.5 for ratio in ratios)} | "
            f"{f'{statistics.median(ratios):.2f}' if ratios else '-'} | "
            f"{share(abs(row['bias']) < 0.5 * row['target'] for row in some if row['target'] != '')} | "
            f"{share(row['true_low'] <= row['target'] for row in reached)} of {len(reached)} | "
            f"{share(row['audit_holds'] in ('True', True) for row in audited)} of {len(audited)} | "
            f"{statistics.median([row['audit_share'] for row in audited] or [0]):.0%} | "
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


def check(rows):
    """By the lower end of the true error's interval; nine of ten errors are to be below what is stated, but few rooms vary."""
    rows = [row for row in rows if row["stated"] not in ("", None)]
    if not rows:
        print("no run has stated an error")
        return 1
    over = [row for row in rows if row["true_low"] > row["stated"]]
    far = [row for row in over if row["true_low"] > 1.5 * row["stated"]]
    print(f"{len(over)} of {len(rows)} errors are certainly above what was stated, {len(far)} by half or more")
    return 1 if far or 6 * len(over) > len(rows) else 0


def main(argv=None):
    arguments = arguments_of(argv)
    arguments.out.mkdir(parents=True, exist_ok=True)
    table = arguments.out / "calibration.csv"
    rows = read_rows(table, FIELDS)
    known = {key_of(row) for row in rows if row["exit"] != "ended"}
    with open(table, "a", newline="", encoding="utf-8") as file, tempfile.TemporaryDirectory() as folder:
        writer = csv.DictWriter(file, FIELDS)
        if file.tell() == 0:
            writer.writeheader()
        for seed, room in rooms_of(arguments):
            obj = Path(folder) / f"room-{seed}.obj"
            room.write(obj)
            for method in arguments.methods:
                for target in arguments.targets if method == "hierarchical" else ("",):
                    if (seed, method, target) in known:
                        continue
                    reference = reference_of(f"room-{seed}-{arguments.pixels}", obj, room.options(arguments.pixels),
                                             arguments.reference_error, arguments.reference_seconds, arguments.threads)
                    reference /= "reference.exr"
                    row = dict.fromkeys(FIELDS, "") | measure(seed, room, obj, method, target, reference, arguments)
                    writer.writerow(row)
                    file.flush()
                    rows = [other for other in rows if key_of(other) != key_of(row)] + [row]
                    if row["exit"] == "ended":
                        print(f"{seed} {room.kind}, {room.lamp}; {method} {target}: ended after {arguments.limit} s", flush=True)
                        continue
                    print(f"{seed} {room.kind}, {room.lamp}; {method} {target}: stated "
                          f"{format(row['stated'], '.2%') if row['stated'] else 'nothing'} ({row['reached']}), true "
                          f"{row['true']:.2%} ({row['true_low']:.2%} to {row['true_high']:.2%}), bias {row['bias']:+.2%}, "
                          f"audit {row['audit_bias'] or 0:+.2%} +- {row['audit_half'] or 0:.2%}, "
                          f"{row['cpu_s']:.1f} s", flush=True)
    text = summary(rows)
    (arguments.out / "calibration.md").write_text(text, encoding="utf-8")
    print(text)
    return check(rows) if arguments.check else 0


if __name__ == "__main__":
    sys.exit(main())
