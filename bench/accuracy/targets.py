#!/usr/bin/env python3
"""What --target-error gives: errors that the hierarchical method was asked for, estimates, and reaches.

    bench/accuracy/targets.py --out bench/results/accuracy [--targets 0.05 0.02 0.01] [--scenes NAME ...]
                              [--hall modern-hall.obj]

writes targets.csv and targets.md. The true error is that of the chart of speed against accuracy: of the picture against
paths of light, noise taken out, over the mean, of the worst colour; where B is known, of the elements. References are
kept in build/references. Needs build/release (scripts/build).
"""

import argparse
import math
import statistics
import sys
from pathlib import Path

sys.dont_write_bytecode = True

from accuracy import RAYS, error_of
from rows import write_rows
from runs import References, Solves
from settings import HIERARCHICAL, Setting, add_scene_options, scenes_of, without

ERRORS = ("discretisation", "rays", "picture", "iteration")
FIELDS = ("scene", "target", "stated", "estimated", *ERRORS, "audit", "audit_low", "audit_high",
          "audit_bias", "audit_half", "audit_share", "reached", "true", "true_low", "true_high", "bias", "cpu_s", "wall_s", "runs", "leaves", "links", "rounds")


def setting_of(scene, target):
    size = scene.resolutions[-1]
    mesh = (*without(scene.options, "--max-edge"), "--target-error", str(target), "--subdivision", HIERARCHICAL.subdivision,
            "--resolution", f"{size}x{size}")
    return Setting(HIERARCHICAL, 0, size, mesh)


def measure(scene, target, solves, references):
    report = solves.run(setting_of(scene, target))
    if report is None:
        sys.exit(f"{scene.name}: the solver did not converge with --target-error {target}")
    true = error_of(scene, setting_of(scene, target), solves, references)
    hierarchy = report["hierarchy"]
    errors, last = hierarchy["errors"], hierarchy["rounds"][-1]
    seconds, audit = report["seconds"], report["audit"]
    bias = max(audit["bias"], key=lambda colour: abs(colour["bias"]))
    return {"scene": scene.name, "target": target, "stated": report["stated_error"], "audit": audit["error"]["value"],
            "audit_low": audit["error"]["low"], "audit_high": audit["error"]["high"], "audit_bias": bias["bias"],
            "audit_half": bias["half_interval"], "audit_share": audit["seconds"] / report["time_s"]["total"],
            "bias": true["bias"], "estimated": math.hypot(*errors.values()), **{name: errors.get(name) for name in ERRORS},
            "reached": hierarchy.get("reached"), "true": true["error"], "true_low": true["low"], "true_high": true["high"],
            "cpu_s": statistics.median(seconds["cpu"]), "wall_s": statistics.median(seconds["wall"]),
            "runs": len(seconds["cpu"]), "leaves": last["leaves"], "links": last["links"],
            "rounds": len(hierarchy["rounds"])}


def verdict(row):
    """Of the true error, as far as the reference's noise lets it be told."""
    if row["true_low"] > row["target"]:
        return f"no, {row['true'] / row['target']:.1f} times it"
    if row["true_high"] > row["target"]:
        return f"not told: {row['true_low']:.2%} to {row['true_high']:.2%}"
    return "yes, under a third" if row["true_high"] < row["target"] / 3 else "yes"


def write_table(path, rows):
    lines = ["| scene | target | stated | estimated | audit: error (95 %) | bias (95 %) | true | at or under the target | its bias | "
             "processor time | of it audit | leaves | links | rounds |",
             "| --- | ---: | ---: | ---: | ---: | ---: | ---: | --- | ---: | ---: | ---: | ---: | ---: | ---: |"]
    for row in rows:
        lines.append(f"| {row['scene']} | {row['target']:.0%} | {row['stated']:.2%} | {row['estimated']:.2%} | "
                     f"{row['audit']:.1%} ({row['audit_low']:.1%} to {row['audit_high']:.1%}) | "
                     f"{row['audit_bias']:+.2%} +- {row['audit_half']:.2%} | {row['true']:.2%} | {verdict(row)} | "
                     f"{row['bias']:+.2%} | {row['cpu_s']:.2f} s | {row['audit_share']:.0%} | {row['leaves']:,} | "
                     f"{row['links']:,} | {row['rounds']} |")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--targets", type=float, nargs="+", default=(0.05, 0.02, 0.01))
    add_scene_options(parser)
    arguments = parser.parse_args()

    scenes = scenes_of(arguments)
    references = References(arguments.references, RAYS["default"], arguments.threads)
    arguments.out.mkdir(parents=True, exist_ok=True)
    rows = []
    for scene in scenes:
        with Solves(scene, arguments.threads) as solves:
            for target in arguments.targets:
                rows.append(measure(scene, target, solves, references))
                print(f"{scene.name}: target {target:.1%}, estimated {rows[-1]['estimated']:.2%}, true "
                      f"{rows[-1]['true']:.2%}, {rows[-1]['cpu_s']:.2f} s", flush=True)
    write_rows(arguments.out / "targets.csv", FIELDS, rows)
    write_table(arguments.out / "targets.md", rows)


if __name__ == "__main__":
    main()
