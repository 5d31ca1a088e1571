#!/usr/bin/env python3
"""Measures what docs/accuracy.md says of the method, and prints it as Markdown tables.

    source scripts/mpi-env.sh; bench/method_tables.py [furnace|point|cube|subscenes ...]

Needs build/release (scripts/build). Runs through mpirun -np 2, sub-scenes through 2 to 10 ranks.
"""

import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

from solution import deviation, mean, read_solution

ROOT = Path(__file__).resolve().parent.parent
FLUXEL = ROOT / "build/release/app/fluxel"


# Names of form factors in the tables -> options.
RULES = {"disc": ("--form-factor", "disc"), "adaptive": (), "closure": ("--closure",)}


def solve(scene, *options, ranks=2, expect=(0,)):
    """Runs one job; its report and, where there is one, its solution."""
    with tempfile.TemporaryDirectory() as folder:
        command = ["mpirun", "-np", str(ranks), "--bind-to", "none", str(FLUXEL), "solve", str(ROOT / "scenes" / scene),
                   "--quiet", "--threads", "1", "--out", folder, *map(str, options)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode not in expect:
            sys.exit(f"{' '.join(command)}\nended with {done.returncode}:\n{done.stderr}")
        report = json.loads((Path(folder) / "report.json").read_text())
        solution = Path(folder) / "solution.ply"
        return report, read_solution(solution) if solution.exists() else []


def table(title, columns, rows):
    print(f"\n{title}\n\n| {' | '.join(columns)} |\n| {' | '.join('---' for _ in columns)} |")
    for row in rows:
        print(f"| {' | '.join(str(cell) for cell in row)} |", flush=True)


def percent(value):
    return f"{100 * value:.2f} %"


def furnace():
    rows = []
    for scene, name in (("furnace/furnace.toml", "random rho 0..0.9"), ("furnace/furnace-0.9.toml", "rho = 0.9")):
        for n, rule in ((n, rule) for n in (8, 16, 32, 64) for rule in RULES):
            if n < 16 and "random" in name:
                continue
            report, elements = solve(scene, "--subdivision", "uniform", "--max-edge", 1.001 / n, "--tolerance", 1e-4,
                                     *RULES[rule])
            rms, largest = deviation(elements, 1.0)
            rows.append((name, n, rule, report["elements"], f"{100 * rms:.4f} %", f"{100 * largest:.4f} %",
                         f"{report['form_factor']['row_sum_max']:.4f}", report["solve"]["iterations"]))
    table("White furnace, B = 1 everywhere",
          ("reflectance", "n a wall", "form factors", "elements", "rms of B - 1", "largest", "largest row sum", "iterations"), rows)


def point():
    rows = []
    for n in (1, 2, 4, 8, 16):
        for rule in ("point", "disc"):
            report, _ = solve("furnace/furnace-0.9.toml", "--subdivision", "uniform", "--max-edge", 1.001 / n,
                              "--form-factor", rule, expect=(0, 3))
            rows.append((n, rule, f"{report['form_factor']['row_sum_max']:.4f}",
                         report["form_factor"]["rows_amplifying"],
                         "converged" if report["solve"]["converged"] else "diverged"
                         if "diverges" in report["solve"]["cause"] else "not converged"))
    table("Closed cube, rho = 0.9: where the point rule diverges",
          ("n a wall", "rule", "largest row sum", "rows with rho times row sum >= 1", "outcome"), rows)


def cube():
    exact = {"emitter": 1.104362, "opposite": 0.171216, "sides": 0.181105}
    rows, before = [], {}
    for n, rule in ((n, rule) for n in (1, 2, 4, 8, 16, 32, 64) for rule in RULES):
        _, elements = solve("emitting-wall/emitting-wall.toml", "--subdivision", "uniform", "--max-edge", 1.001 / n,
                            "--tolerance", 1e-5, *RULES[rule])
        walls = {}
        for element in elements:
            walls.setdefault(element[1], []).append(element)
        means = [mean(walls[patch]) for patch in sorted(walls)]  # in the OBJ's order: emitter, opposite, four sides
        found = {"emitter": means[0], "opposite": means[1], "sides": sum(means[2:]) / 4}
        error = {wall: found[wall] / exact[wall] - 1 for wall in exact}
        order = {wall: math.log2(abs(before[rule][wall] / error[wall])) if rule in before else float("nan") for wall in exact}
        rows.append((n, rule, len(elements), *(f"{found[w]:.6f} ({100 * error[w]:.3f} %)" for w in exact),
                     f"{order['emitter']:.2f}", f"{sum(means):.5f}"))
        before[rule] = error
    table("Unit cube, one wall emits 1, rho = 0.5; continuous solution: 1.104362, 0.171216, 0.181105, sum 2",
          ("n a wall", "form factors", "elements", "emitter", "opposite", "sides", "order (emitter)", "sum over the walls"), rows)


def subscenes():
    rows = []
    for scene, resolution in (("cornell-box/cornell-box.toml", "256x256"),
                              ("construction-in-wood/construction-in-wood.toml", "128x128"),
                              ("office-2391/office-2391.toml", "128x128")):
        counts = []
        for ranks in range(1, 11):
            report, _ = solve(scene, "--resolution", resolution, "--subscenes", "independent", "--dry-run", ranks=ranks)
            counts.append(report["elements"])
        rows.append((f"{Path(scene).stem} {resolution}", counts[0],
                     *(f"{count / counts[0]:.3f}" for count in counts[1:])))
    table("Elements with independent sub-scenes over those with merged ones (which are those of one rank)",
          ("scene", "merged", *(f"np {ranks}" for ranks in range(2, 11))), rows)


TABLES = {"furnace": furnace, "point": point, "cube": cube, "subscenes": subscenes}

if __name__ == "__main__":
    for chosen in sys.argv[1:] or TABLES:
        if chosen not in TABLES:
            sys.exit(f"no table '{chosen}'; there are {', '.join(TABLES)}")
        TABLES[chosen]()
