#!/usr/bin/env python3
"""Efficiency of the hierarchical method by rays on many ranks, from runs with 1 to 4.

    source scripts/mpi-env.sh; bench/simulate/rays.py small.obj large.obj --options "--target-error 0.05 --eye ..."
        --csv bench/results/scaling/rays.csv

A phase takes S + W / P seconds on P ranks of one thread: S is what one rank, the leader of a host or every rank does alone,
W what they share. The two scenes, of which the larger is best made of copies of the smaller (bench/growth/side_by_side.py),
are solved at np 1 and 2, once each, of which every rank has a core: they give S and W of each phase by the clock, and agree
with the model because of that. The small one at np 3 and 4 checks it: there cores are shared, and W / P + S becomes W / cores + S. What
is told of more ranks is computed, not measured: S and W grow linearly with triangles, as the two scenes have them, and
collective calls are added, each of two steps for each level of a binary tree, of the latency and the sleep of waiting ranks
that the simulation of the matrix has (docs in bench/results/scaling.md). Reading and writing of files are told apart.
"""

import argparse
import csv
import json
import math
import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
FLUXEL = ROOT / "build/release/app/fluxel"
PHASES = ("load", "subdivision", "solve", "energy", "gather", "image")
APART = ("load", "image")  # reading and writing of files, of the root
MEASURED, CHECKED = (1, 2), (3, 4)
CORES = len(os.sched_getaffinity(0))
LATENCY, SLEEP, BANDWIDTH = 1.5e-6, 52e-6, 12e9  # InfiniBand, 100 Gb/s [s, s, bytes/s]
BYTES_PER_UNKNOWN, UNKNOWNS_PER_ROW, BYTES_PER_POINT = 24, 6, 48


def run(scene, options, ranks):
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run(["mpirun", "-np", str(ranks), "--bind-to", "none", str(FLUXEL), "solve", str(scene), "--threads",
                               "1", "--quiet", "--exchange", "rays", "--out", folder, *options], capture_output=True, text=True,
                              check=False, env=os.environ | {"OMPI_MCA_rmaps_base_oversubscribe": "1"})
        if done.returncode not in (0, 3):
            sys.exit(done.stderr)
        return json.loads((Path(folder) / "report.json").read_text(encoding="utf-8"))


class Model:
    """Of a scene: alone and shared seconds of each phase, and what ranks exchange."""

    def __init__(self, reports):
        one, two = (reports[ranks]["time_s"] for ranks in MEASURED)
        self.shared = {phase: max(0.0, 2 * (one.get(phase, 0) - two.get(phase, 0))) for phase in PHASES}
        self.alone = {phase: max(0.0, one.get(phase, 0) - self.shared[phase]) for phase in PHASES}
        report = reports[1]
        self.triangles = report["scene"]["faces_read"]
        rounds = report["hierarchy"]["rounds"]
        # Of each product all ranks get all unknowns; importance is solved for too.
        self.products = 2 * sum(of["iterations"] for of in rounds)
        self.rows = rounds[-1]["rows"]
        self.gathered = math.prod(report["options"]["resolution"]) * BYTES_PER_POINT

    def messages(self, ranks):
        """Seconds of collective calls in all phases."""
        if ranks == 1:
            return 0.0
        calls = self.products + 40
        bytes_moved = self.products * self.rows * UNKNOWNS_PER_ROW * BYTES_PER_UNKNOWN + 4 * self.gathered
        return calls * 2 * math.log2(ranks) * (LATENCY + SLEEP) + bytes_moved / BANDWIDTH

    def seconds(self, ranks, phases, cores=None):
        at_once = min(ranks, cores or ranks)
        return sum(self.alone[phase] + self.shared[phase] / at_once for phase in phases)


def at_size(small, large, triangles):
    """What both scenes let expect of so many triangles."""
    model = object.__new__(Model)
    share = (triangles - small.triangles) / (large.triangles - small.triangles)
    for name in ("alone", "shared"):
        of_small, of_large = getattr(small, name), getattr(large, name)
        setattr(model, name, {phase: max(0.0, of_small[phase] + share * (of_large[phase] - of_small[phase])) for phase in PHASES})
    model.triangles = triangles
    for name in ("products", "rows", "gathered"):
        setattr(model, name, getattr(large, name))
    return model


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("small", type=Path)
    parser.add_argument("large", type=Path)
    parser.add_argument("--options", default="", help="of fluxel solve: camera, target")
    parser.add_argument("--triangles", type=float, nargs="+", default=(1e6, 1e7))
    parser.add_argument("--ranks", type=int, nargs="+", default=(2, 4, 16, 64, 256, 1024))
    parser.add_argument("--csv", type=Path, required=True)
    arguments = parser.parse_args()
    options = shlex.split(arguments.options)

    models, rows = [], []
    compute = [phase for phase in PHASES if phase not in APART]
    print("| scene | np | seconds, predicted / measured | | S | W |\n" + "| --- " * 6 + "|")
    for scene in (arguments.small, arguments.large):
        checked = CHECKED if scene == arguments.small else ()
        reports = {ranks: run(scene, options, ranks) for ranks in (*MEASURED, *checked)}
        model = Model(reports)
        models.append(model)
        for ranks, report in reports.items():
            measured, predicted = report["time_s"]["total"], model.seconds(ranks, PHASES, CORES)
            rows.append({"scene": scene.stem, "triangles": model.triangles, "ranks": ranks, "measured_s": measured,
                         "predicted_s": predicted, "alone_s": sum(model.alone.values()), "shared_s": sum(model.shared.values())})
            print(f"| {scene.stem} | {ranks} | {predicted:.1f} / {measured:.1f} | {predicted / measured - 1:+.0%} | "
                  f"{sum(model.alone.values()):.1f} s | {sum(model.shared.values()):.1f} s |", flush=True)
        for phase in PHASES:
            print(f"    {scene.stem}: {phase}: alone {model.alone[phase]:.2f} s, shared {model.shared[phase]:.2f} s")

    print("\n| triangles | ranks | efficiency | without reading and writing files | seconds |\n" + "| --- " * 5 + "|")
    for triangles in arguments.triangles:
        model = at_size(*models, triangles)
        for ranks in arguments.ranks:
            def efficiency(phases):
                seconds = model.seconds(ranks, phases) + model.messages(ranks)
                return model.seconds(1, phases) / (ranks * seconds), seconds
            (whole, seconds), (computed, _) = efficiency(PHASES), efficiency(compute)
            rows.append({"scene": "computed", "triangles": triangles, "ranks": ranks, "predicted_s": seconds, "efficiency": whole,
                         "without_files": computed})
            print(f"| {triangles:.0e} | {ranks} | {whole:.2f} | {computed:.2f} | {seconds:.1f} |")
    arguments.csv.parent.mkdir(parents=True, exist_ok=True)
    with open(arguments.csv, "w", newline="", encoding="utf-8") as file:
        writer = csv.DictWriter(file, ("scene", "triangles", "ranks", "measured_s", "predicted_s", "alone_s", "shared_s",
                                       "efficiency", "without_files"))
        writer.writeheader()
        writer.writerows(rows)


if __name__ == "__main__":
    main()
