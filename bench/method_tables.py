#!/usr/bin/env python3
"""Measures what bench/results/accuracy.md says of the method, and prints it as Markdown tables.

    source scripts/mpi-env.sh; bench/method_tables.py [furnace|point|cube|energy|subscenes|cost ...]

Needs build/release (scripts/build) and numpy. Runs through mpirun -np 2, sub-scenes through 2 to 10 ranks; what is timed runs
on one rank of one thread, in processor time, which other programs on the machine hardly change.
"""

import math
import resource
import statistics
import sys
import warnings
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "python"))

import fluxel
import numpy as np
from exact import deviation, red


# Names of form factors in the tables -> options.
RULES = {"disc": {"form_factor": "disc"}, "adaptive": {}, "closure": {"closure": True}}


def solve(scene, ranks=2, may_diverge=False, **options):
    """Runs one job; its fluxel.Solution. One that does not converge ends the program, unless it may."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore" if may_diverge else "error", fluxel.NotReachedWarning)
        return fluxel.solve(ROOT / "scenes" / scene, ranks=ranks, method="matrix", no_error_estimate=True, threads=1, **options)


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
            solution = solve(scene, subdivision="uniform", max_edge=1.001 / n, tolerance=1e-4, **RULES[rule])
            report = solution.report
            rms, largest = deviation(solution.elements, 1.0)
            rows.append((name, n, rule, report["elements"], f"{100 * rms:.4f} %", f"{100 * largest:.4f} %",
                         f"{report['form_factor']['row_sum_max']:.4f}", report["solve"]["iterations"]))
    table("White furnace, B = 1 everywhere",
          ("reflectance", "n a wall", "form factors", "elements", "rms of B - 1", "largest", "largest row sum",
           "iterations"), rows)


def point():
    rows = []
    for n in (1, 2, 4, 8, 16):
        for rule in ("point", "disc", "adaptive"):
            report = solve("furnace/furnace-0.9.toml", may_diverge=True, subdivision="uniform", max_edge=1.001 / n,
                           form_factor=rule).report
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
        elements = solve("emitting-wall/emitting-wall.toml", subdivision="uniform", max_edge=1.001 / n, tolerance=1e-5,
                         **RULES[rule]).elements
        # In the OBJ's order: emitter, opposite, four sides.
        power, area = (np.bincount(elements.patch, of) for of in (elements.areas * red(elements), elements.areas))
        means = power / area
        found = {"emitter": means[0], "opposite": means[1], "sides": sum(means[2:]) / 4}
        error = {wall: found[wall] / exact[wall] - 1 for wall in exact}
        order = f"{math.log2(abs(before[rule]['emitter'] / error['emitter'])):.2f}" if rule in before else "-"
        rows.append((n, rule, len(elements), *(f"{found[w]:.6f} ({100 * error[w]:.3f} %)" for w in exact), order,
                     f"{sum(means):.5f}"))
        before[rule] = error
    table("Unit cube, one wall emits 1, rho = 0.5; continuous solution: 1.104362, 0.171216, 0.181105, sum 2",
          ("n a wall", "form factors", "elements", "emitter", "opposite", "sides", "order (emitter)",
           "sum over the walls"), rows)


def energy():
    rows = []
    for scene, options in (("cornell-box", {"resolution": "128x128"}), ("furnace", {}), ("courtyard", {"resolution": "100x100"})):
        for rule in ("disc", "adaptive"):
            report = solve(f"{scene}/{scene}.toml", tolerance=1e-4, form_factor=rule, **options).report
            balance = report["energy"]
            sampling = max(error / power for error, power in zip(balance["sampling_error"], balance["emitted"]))
            rows.append((" ".join((scene, *options.values())), rule, report["elements"],
                         percent(balance["defect_relative"]), percent(sampling)))
    table("Energy that is unaccounted for, of the emitted power",
          ("scene", "form factors", "elements", "defect", "standard error of the rays"), rows)


def subscenes():
    rows = []
    for scene, resolution in (("cornell-box/cornell-box.toml", "256x256"),
                              ("construction-in-wood/construction-in-wood.toml", "128x128"),
                              ("office-2391/office-2391.toml", "128x128")):
        counts = []
        for ranks in range(1, 11):
            counts.append(solve(scene, ranks, resolution=resolution, subscenes="independent", dry_run=True).report["elements"])
        rows.append((f"{Path(scene).stem} {resolution}", counts[0],
                     *(f"{count / counts[0]:.3f}" for count in counts[1:])))
    table("Elements with independent sub-scenes over those with merged ones (which are those of one rank)",
          ("scene", "merged", *(f"np {ranks}" for ranks in range(2, 11))), rows)


def difference(elements, reference):
    """Area-weighted rms, mean and largest size of B - reference over the reference's mean, each colour by
    itself; of the three colours the rms, the mean and the largest."""
    weights = reference.areas / reference.areas.sum()
    exact = reference.radiosity.astype(float)
    errors = (elements.radiosity - exact) / (weights @ exact)
    return math.sqrt((weights @ errors**2).mean()), (weights @ errors).mean(), abs(errors).max()


def cost(repeat=3):
    ways = {"`point`": {"form_factor": "point"}, "`disc`": {"form_factor": "disc"},
            "`adaptive --no-partial-visibility`": {"no_partial_visibility": True}, "`adaptive`": {},
            "`adaptive`, tolerance 1e-4": {"form_factor_tolerance": 1e-4}}

    def run(way):
        def used():
            children = resource.getrusage(resource.RUSAGE_CHILDREN)
            return children.ru_utime + children.ru_stime
        before = used()
        solution = solve("cornell-box/cornell-box.toml", 1, resolution="128x128", tolerance=1e-4, **ways[way])
        return solution, used() - before

    *coarser, finest = ways
    found, seconds = {}, {way: [] for way in ways}
    found[finest], taken = run(finest)
    seconds[finest].append(taken)
    reference = found[finest].elements
    for _ in range(repeat):  # in turns, so that a slower minute of the machine meets all
        for way in coarser:
            found[way], taken = run(way)
            seconds[way].append(taken)
    rows = []
    for way in ways:
        report = found[way].report
        errors = map(percent, difference(found[way].elements, reference)) if way != finest else ("-",) * 3
        corrections, time = report["form_factor"], statistics.median(seconds[way])
        rows.append((way, *errors, f"{time:.1f} s", f"{time / statistics.median(seconds[coarser[0]]):.2f}",
                     f"{corrections['bytes'] / 1e6:.1f} MB", f"{corrections['rays'] / 1e6:.3g} million"))
    table(f"Cornell box, 128x128, {len(reference)} elements: B against the last row's, processor time of the run",
          ("form factors", "rms", "bias", "largest", "time", "over point", "corrections", "rays for them"), rows)


TABLES = {"furnace": furnace, "point": point, "cube": cube, "energy": energy, "subscenes": subscenes, "cost": cost}

if __name__ == "__main__":
    for chosen in sys.argv[1:] or TABLES:
        if chosen not in TABLES:
            sys.exit(f"no table '{chosen}'; there are {', '.join(TABLES)}")
        TABLES[chosen]()
