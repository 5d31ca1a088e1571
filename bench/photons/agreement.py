#!/usr/bin/env python3
"""Do four methods that share little come to the same light? Radiosity by matrix and by links, photons, paths of light.

  bench/photons/agreement.py [--fluxel build/unity/app/fluxel] [--hall modern-hall.obj] [--scenes NAME ...]

Of each scene the mean radiosity of the same elements by all methods, compared pairwise by `fluxel compare`: what is left of the
root mean square difference over the mean when the noise is taken off, its standard error, and the bias of the mean. A Markdown table.
"""

import argparse
import itertools
import json
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# File, edge, photons, error of the reference, target of the hierarchical method.
SCENES = {
    "cornell-box": (ROOT / "scenes/cornell-box/cornell-box.toml", 0.05, 2e7, 0.01, 0.01),
    "construction-in-wood": (ROOT / "scenes/construction-in-wood/construction-in-wood.toml", 0.5, 1e7, 0.01, 0.01),
    "corridor": (ROOT / "scenes/corridor/corridor.toml", 0.4, 1e7, 0.01, 0.01),
    "office-luminaires": (ROOT / "scenes/office-luminaires/office-luminaires.toml", 0.4, 2e7, 0.02, 0.02),
}
METHODS = ("matrix", "hierarchical", "photons", "reference")


def run(program, *arguments, codes=(0, 3)):
    job = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if job.returncode not in codes:
        sys.exit(f"{' '.join(map(str, arguments))}\n{job.stderr}")
    return job.stdout


def solutions(program, folder, scene, edge, photons, error, target):
    """The file of elements of each method, and its seconds."""
    elements = ("--subdivision", "uniform", "--max-edge", edge)
    run(program, "solve", scene, "--method", "matrix", *elements, "--quiet", "--out", folder / "matrix")
    run(program, "solve", scene, "--method", "hierarchical", *elements, "--target-error", target, "--error-of", "surfaces", "--quiet",
        "--out", folder / "hierarchical")
    given = ("--elements", folder / "matrix/solution.ply", "--only", "elements", "--quiet")
    run(program, "photons", scene, *given, "--photons", int(photons), "--out", folder / "photons")
    run(program, "reference", scene, *given, "--target-error", error, "--out", folder / "reference")
    for method, file in zip(METHODS, ("solution.ply", "solution.ply", "photons.ply", "reference.ply")):
        report = json.loads((folder / method / {"photons": "photons.json", "reference": "reference.json"}.get(
            method, "report.json")).read_text())
        yield method, folder / method / file, report


def figures(program, a, b):
    """Difference without noise, where one standard error takes it, and bias, of the green channel [%]."""
    found = {}
    for line in run(program, "compare", a, b).splitlines():
        words = line.split()
        for name in ("sigma without noise", "and up", "bias", "sigma"):
            if line.strip().startswith(name + " ") and words[-1] == "%":
                found.setdefault(name, float(words[-4]))
    return found.get("sigma without noise", found["sigma"]), found.get("and up"), found["bias"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--fluxel", default=str(ROOT / "build/unity/app/fluxel"))
    parser.add_argument("--hall", type=Path)
    parser.add_argument("--hall-only", action="store_true")
    parser.add_argument("--scenes", nargs="+", choices=tuple(SCENES))
    options = parser.parse_args()
    scenes = {name: SCENES[name] for name in options.scenes or SCENES}
    if options.hall_only:
        scenes = {}
    if options.hall:
        scenes["modern-hall"] = (options.hall, 2.0, 2e7, 0.02, 0.05)
    print("| scene | A | B | difference without noise | one standard error up | bias of the mean |\n|" + " --- |" * 6, flush=True)
    for name, values in scenes.items():
        with tempfile.TemporaryDirectory() as folder:
            found = list(solutions(options.fluxel, Path(folder), *values))
            for method, _, report in found[:2]:
                stated = report.get("stated_error")
                print(f"| {name} | {method} | states | {'-' if stated is None else f'{100 * stated:.2f} %'} | | |", flush=True)
            for (a, file_a, _), (b, file_b, _) in itertools.combinations(found, 2):
                sigma, up, bias = figures(options.fluxel, file_a, file_b)
                print(f"| {name} | {a} | {b} | {sigma:.3f} % | {f'{up:.3f} %' if up is not None else '-'} | {bias:+.3f} % |", flush=True)


if __name__ == "__main__":
    main()
