#!/usr/bin/env python3
"""Processor time of two builds of Fluxel, in turns: the benches and whole runs, as a Markdown table.

    bench/same_speed.py OLD NEW [--repeat 5]      # build folders, such as build/release

Each command runs alternately from both folders, on one thread: medians, their ratio, and the least and the greatest
ratio of two runs that followed each other. Ends with 1 where NEW takes more than 3 % longer.
"""

import argparse
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
CORNELL = ROOT / "scenes" / "cornell-box" / "cornell-box.toml"
SOLVE = ("app/fluxel", "solve", CORNELL, "--threads", "1", "--quiet", "--out", "{out}")
LIMIT = 1.03
COMMANDS = {
    "row kernel": ("bench/solver/solver_bench", "kernel", "--rows", "64", "--repeat", "3", "--out", "{out}"),
    "operator": ("bench/solver/solver_bench", "operator", "--elements", "6000", "--repeat", "3", "--out", "{out}"),
    "solvers": ("bench/solver/solver_bench", "methods", "--elements", "2000", "--repeat", "1", "--limit", "5", "--out", "{out}"),
    "visibility, cornell-box": ("bench/visibility/visibility_bench", "trace", "cornell-box", "--size", "8000"),
    "camera subdivision": ("bench/visibility/visibility_bench", "subdivision", "--only", "cornell-box", "--resolutions", "512",
                           "--out", "{out}"),
    "view factors": ("bench/view_factors/view_factors_bench", "cubes", "--divisions", "6", "--tolerances", "0.01"),
    "Cornell box, hierarchical, 128x128": (*SOLVE, "--resolution", "128x128", "--method", "hierarchical"),
    "Cornell box, matrix, 64x64": (*SOLVE, "--resolution", "64x64", "--method", "matrix"),
    "Cornell box, reference": ("app/fluxel", "reference", CORNELL, "--threads", "1", "--quiet", "--out", "{out}", "--resolution",
                               "64x64", "--rays", "3000000"),
}


def processor_seconds(folder, command, out):
    """Of the command's own process; it must not end with more than 3, which tells that a target was not reached."""
    arguments = [str(folder / command[0]), *(str(part).format(out=out) for part in command[1:])]
    with subprocess.Popen(arguments, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        said = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode not in (0, 3):
        sys.exit(f"{' '.join(arguments)}\nended with {process.returncode}:\n{said}")
    return usage.ru_utime + usage.ru_stime


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old", type=Path)
    parser.add_argument("new", type=Path)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--only", nargs="+", choices=COMMANDS, default=list(COMMANDS), metavar="NAME")
    arguments = parser.parse_args()
    slower = False
    print("| bench | old [s] | new [s] | new over old | least and greatest |\n| --- | ---: | ---: | ---: | ---: |")
    for name in arguments.only:
        seconds = {arguments.old: [], arguments.new: []}
        with tempfile.TemporaryDirectory() as work:
            for _ in range(arguments.repeat):
                for folder, runs in seconds.items():
                    runs.append(processor_seconds(folder.resolve(), COMMANDS[name], Path(work) / "out"))
        old, new = (statistics.median(runs) for runs in seconds.values())
        ratios = sorted(b / a for a, b in zip(*seconds.values()))
        slower |= new > LIMIT * old
        print(f"| {name} | {old:.2f} | {new:.2f} | {new / old:.3f} | {ratios[0]:.3f} to {ratios[-1]:.3f} |", flush=True)
    sys.exit(1 if slower else 0)


if __name__ == "__main__":
    main()
