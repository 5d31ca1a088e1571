#!/usr/bin/env python3
"""Compares what the simulation predicts of the visibility phase with real runs on this machine.

    source scripts/mpi-env.sh; /usr/bin/python3 bench/simulate/validate.py --machine machine.json --out validation.csv

Traces two scenes, runs them at np 1 to 4 in turns, and prints seconds by the clock, seconds of processor time, idle share
and bytes, predicted and measured; of repeated runs the one with the least processor time counts, which other programs
disturbed least. Where ranks share cores the simulation shares them evenly.
"""

import argparse
import csv
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FLUXEL = ROOT / "build/release/app/fluxel"
SIMULATE = ROOT / "build/release/bench/simulate/simulate_bench"
# Scene of the benchmark -> its file, elements, and the edge that makes as many.
SCENES = {"room-of-180-boxes": ("room-of-boxes/room-of-180-boxes.toml", 58_000, 0.155),
          "office-2391": ("office-2391/office-2391.toml", 15_368, 0.22)}


def run_program(*command):
    done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):  # 3: the solve, which does not matter here, was cut short
        sys.exit(f"{' '.join(map(str, command))}\nended with {done.returncode}:\n{done.stderr}")


def measure(scene, ranks):
    """The visibility phase of one run, as the report has it."""
    file, _, edge = SCENES[scene]
    with tempfile.TemporaryDirectory() as folder:
        run_program("mpirun", "-np", ranks, "--bind-to", "none", FLUXEL, "solve", ROOT / "scenes" / file, "--method",
                    "matrix", "--quiet", "--threads", 1, "--subdivision", "uniform", "--max-edge", edge, "--form-factor",
                    "point", "--max-iterations", 1, "--out", folder)
        report = json.loads((Path(folder) / "report.json").read_text())
    parts = [rank["visibility"] for rank in report["ranks_detail"]]
    waiting = sum(part["waiting_s"] for part in parts)
    spent = waiting + sum(part["busy_s"] + part["message_s"] for part in parts)
    return {"elements": report["elements"], "visibility_s": report["time_s"]["visibility"],
            "cpu_s": report["cpu_s"]["visibility"], "idle": waiting / spent,
            "bytes": sum(part["bytes_sent"] for part in parts)}


def predict(scene, machine, ranks, folder):
    """Ranks -> what the simulation says; the tiles are traced anew, since processors change their speed."""
    traced, table = folder / f"{scene}.traced", folder / f"{scene}.csv"
    run_program(SIMULATE, "trace", "--scene", scene, "--elements", SCENES[scene][1], "--blocks", 256, "--tiles", 16,
                "--out", traced)
    run_program(SIMULATE, "predict", traced, "--machine", machine, "--cores", len(os.sched_getaffinity(0)), "--ranks",
                ",".join(map(str, ranks)), "--out", table)
    with open(table, newline="", encoding="utf-8") as file:
        return {int(row["ranks"]): {key: float(row[key]) for key in row if key != "scene"}
                for row in csv.DictReader(file)}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--machine", required=True, help="file of simulate_bench machine")
    parser.add_argument("--ranks", default="1,2,3,4")
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--out", required=True, help="CSV")
    arguments = parser.parse_args()
    ranks = [int(part) for part in arguments.ranks.split(",")]
    columns = ("elements", "visibility_s", "cpu_s", "idle", "bytes")
    with open(arguments.out, "w", newline="", encoding="utf-8") as file, tempfile.TemporaryDirectory() as folder:
        writer = csv.writer(file)
        writer.writerow(["scene", "ranks", *(f"{kind}_{column}" for column in columns for kind in ("predicted", "measured"))])
        for scene in SCENES:
            predicted = predict(scene, arguments.machine, ranks, Path(folder))
            runs = {count: [] for count in ranks}
            for _ in range(arguments.repeat):
                for count in ranks:
                    runs[count].append(measure(scene, count))
            for count in ranks:
                measured = min(runs[count], key=lambda run: run["cpu_s"])
                writer.writerow([scene, count, *(side[column] for column in columns
                                                 for side in (predicted[count], measured))])
                shown = [f"{column} {predicted[count][column]:.4g} / {measured[column]:.4g}" for column in columns]
                print(f"{scene}, np {count}, predicted / measured: {', '.join(shown)}", flush=True)


if __name__ == "__main__":
    main()
