#!/usr/bin/env python3
"""Processor time of whole runs of the matrix method and of starts of the program, by phase, as Markdown tables.

    bench/whole_runs.py build/release/app/fluxel [--before OTHER/fluxel] [--repeat 2]

One thread, without the audit. `--before`: the same by another build, in turns. A number for each repetition.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CORNELL = ROOT / "scenes" / "cornell-box" / "cornell-box.toml"
MATRIX = ("solve", CORNELL, "--method", "matrix", "--threads", "1", "--audit", "0", "--quiet")
STARTS = {
    "`--version`": (["--version"], 0),
    "a scene that is missing": (["solve", "{out}/missing.toml"], 2),
    "Cornell box 16x16, matrix": ([*MATRIX, "--resolution", "16x16", "--out", "{out}"], 0),
    "Cornell box, links, target 20 %": (["solve", CORNELL, "--target-error", "0.2", "--resolution", "16x16", "--threads", "1",
                                         "--quiet", "--out", "{out}"], 0),
}


def run(program, arguments, folder, expected=0):
    """Runs a program; returns its processor time and that by the clock [s]."""
    command = [str(program)] + [str(a).replace("{out}", str(folder)) for a in arguments]
    before, start = os.times(), time.perf_counter()
    ended = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
    elapsed, after = time.perf_counter() - start, os.times()
    if ended.returncode != expected:
        sys.exit(f"{' '.join(command)}: exit code {ended.returncode}\n{ended.stderr}")
    return (after.children_user + after.children_system - before.children_user - before.children_system, elapsed)


def matrix_row(program, arguments):
    """What a run of the matrix method took, by phase [s of the processor]."""
    with tempfile.TemporaryDirectory() as folder:
        whole, _ = run(program, [*MATRIX, *arguments, "--out", "{out}"], folder)
        report = json.loads((Path(folder) / "report.json").read_text())
    phases, factors, solve = report["cpu_s"], report["form_factor"], report["solve"]
    return {
        "whole run": f"{whole:.1f}",
        "visibility": f"{phases['visibility']:.1f}",
        "form factors: escape fractions, corrections, row sums": f"{phases['form_factors']:.1f}",
        "of these the corrections, by the clock": f"{report['progress']['corrections']['final_s']:.1f}",
        "solve": f"{phases['solve']:.1f}",
        "error estimate: coarser meshes": f"{phases['estimate']:.1f}",
        "iterations": f"{solve['iterations']}",
        "estimated error of the elements, largest channel": f"{100 * max(report['error_estimate']['discretisation_rgb']):.2f} %",
        "rays of the corrections": f"{factors['rays']:.3g}",
        "partly visible pairs": f"{factors['partial_pairs']}",
        "pairs clipped": f"{factors.get('clipped_pairs', 0)}",
    }


def start_row(program, name):
    arguments, expected = STARTS[name]
    with tempfile.TemporaryDirectory() as folder:
        return f"{run(program, arguments, folder, expected)[1]:.2f}"


def print_table(title, names, rows):
    """`rows`: what -> version -> a text for each repetition."""
    print(f"| {title} | {' | '.join(names)} |\n| --- |{' ---: |' * len(names)}")
    for what, by_version in rows.items():
        print(f"| {what} | {' | '.join('; '.join(by_version[name]) for name in names)} |")
    print(flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fluxel", type=Path)
    parser.add_argument("--before", type=Path, help="another build, in turns with the first")
    parser.add_argument("--repeat", type=int, default=2)
    parser.add_argument("--resolution", default="256x256")
    options = parser.parse_args()
    versions = ({"before": options.before} if options.before else {}) | {"now": options.fluxel}
    whole, starts = {}, {}
    for _ in range(options.repeat):
        for name, program in versions.items():
            for what, text in matrix_row(program, ["--resolution", options.resolution]).items():
                whole.setdefault(what, {}).setdefault(name, []).append(text)
    for what in STARTS:
        for _ in range(max(3, options.repeat)):
            for name, program in versions.items():
                starts.setdefault(what, {}).setdefault(name, []).append(start_row(program, what))
    print_table(f"Cornell box, {options.resolution} [s of the processor]", list(versions), whole)
    print_table("start [s by the clock]", list(versions), starts)


if __name__ == "__main__":
    main()
