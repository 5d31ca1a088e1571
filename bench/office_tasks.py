#!/usr/bin/env python3
"""Light meters, glare and verdicts of an office: a solve against paths of light, as a Markdown table.

    FLUXEL=build/release/app/fluxel bench/office_tasks.py [--target-error 0.02] [--seconds 120]

A value is told as `solve (its error) / reference (its noise)`.
"""

import argparse
import math
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "python"))

import fluxel

SCENE = ROOT / "scenes/office-luminaires/office-tasks.toml"
FIGURES = ("mean", "min", "max", "u0")


def stated(value):
    return f"{value['value']:.4g} ({value['error']:.2g})"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--target-error", type=float, default=0.02)
    parser.add_argument("--seconds", type=float, default=120, help="of the reference, a receiver")
    arguments = parser.parse_args()
    start = time.monotonic()
    solved = fluxel.solve(SCENE, target_error=arguments.target_error, maintenance_factor=0.8)
    seconds = time.monotonic() - start
    truth = fluxel.reference(SCENE, only="receivers", target_error=0.002, time=arguments.seconds)
    print(f"Solve: {seconds:.0f} s, stated error {100 * solved.stated_error:.2g} %.\n")
    print("| receiver | " + " | ".join(FIGURES) + " |\n| --- |" + " ---: |" * len(FIGURES))
    worst = 0
    for name, found in solved.report["receivers"].items():
        exact = truth.report["measured"][f"receiver {name}"]
        print(f"| {name} [{found['unit']}] | " + " | ".join(f"{stated(found[figure])} / {stated(exact[figure])}" for figure in FIGURES) + " |")
        for figure in FIGURES:
            off = abs(found[figure]["value"] - exact[figure]["value"])
            worst = max(worst, off / math.hypot(found[figure]["error"], exact[figure]["error"]))
    print("\n| observer | UGR |\n| --- | ---: |")
    for name, found in solved.report["observers"].items():
        print(f"| {name} | {stated(found['ugr'])} / {stated(truth.report['observers'][name]['ugr'])} |")
    print(f"\nThe largest difference is {worst:.2g} of what is stated. Verdicts: "
          + ", ".join(f"{task['name']}: {task['verdict']}" for task in solved.report["tasks"]) + ".")


if __name__ == "__main__":
    main()
