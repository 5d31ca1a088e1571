#!/usr/bin/env python3
"""Speed against accuracy: solves every scene by every method at every setting and compares the pictures with
references by paths of light.

    bench/accuracy/accuracy.py --out bench/results/accuracy [--set small|default|full] [--scenes NAME ...]
                               [--hall modern-hall.obj] [--methods LABEL ...]

writes accuracy.csv (a row a solve), reference.csv (the references' own errors over time), the charts (PNG and SVG) and
table.md. References are kept in build/references, by a hash of the scene, and are not in the times. Needs
build/release (scripts/build), numpy and matplotlib.
"""

import argparse
import csv
import dataclasses
import statistics
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True

from chart import draw
from curves import REFERENCES
from rows import write_rows
from runs import References, Solves, compare, exact_error, load
from settings import METHODS, add_scene_options, scenes_of, settings_of
from table import write_table

RAYS = {"small": 4_000_000, "default": 60_000_000, "full": 600_000_000}
FIELDS = ("scene", "method", "resolution", "elements", "wall_s", "wall_low_s", "wall_high_s", "cpu_s", "runs", "error",
          "error_low", "error_high", "bias", "noise")


def small(scene):
    """The two coarsest steps: for a check that all this works."""
    return dataclasses.replace(scene, resolutions=scene.resolutions[:1], edges=scene.edges[:1],
                               block_errors=scene.block_errors[:1])


def full(scene):
    """A step finer than the default set."""
    return dataclasses.replace(scene, resolutions=(*scene.resolutions, 2 * scene.resolutions[-1]),
                               edges=(*scene.edges, scene.edges[-1] / 2),
                               block_errors=(*scene.block_errors, scene.block_errors[-1] / 4))


def row_of(scene, setting, report, error):
    wall, cpu = report["seconds"]["wall"], report["seconds"]["cpu"]
    return {"scene": scene.name, "method": setting.method.label, "resolution": setting.resolution,
            "elements": report["elements"], "wall_s": statistics.median(wall), "wall_low_s": min(wall),
            "wall_high_s": max(wall), "cpu_s": statistics.median(cpu), "runs": len(wall), "error": error["error"],
            "error_low": error["low"], "error_high": error["high"], "bias": error["bias"], "noise": error["noise"]}


def error_of(scene, setting, solves, references):
    if scene.exact is not None:
        return exact_error(solves.out / "solution.ply", scene.exact)
    reference = references.picture(scene, setting.resolution)
    return compare(solves.out / "image.exr", reference / "reference.exr", solves.folder / "compare")


def chosen_settings(scene, methods):
    return [setting for setting in settings_of(scene) if not methods or setting.method.label in methods]


def measure(scene, methods, references, threads):
    rows = []
    with Solves(scene, threads) as solves:
        for setting in chosen_settings(scene, methods):
            report = solves.run(setting)
            if report is None:
                print(f"{scene.name}: {setting.method.label} at {setting.resolution} did not converge", flush=True)
                continue
            error = error_of(scene, setting, solves, references)
            rows.append(row_of(scene, setting, report, error))
            print(f"{scene.name}: {setting.method.label}, {report['elements']} elements, "
                  f"{rows[-1]['wall_s']:.2f} s, {100 * error['error']:.2f} %", flush=True)
    return rows


def reference_rows(scene, references, sampling):
    """How the reference's own error at the finest picture fell."""
    kept = references.picture(scene, scene.resolutions[-1], sampling)
    measured = load(kept / "reference.json")["measured"]["picture"]
    return [{"scene": scene.name, "sampling": sampling, "wall_s": state["seconds"], "cpu_s": state["cpu_s"],
             "error": max(state["relative_error_rgb"])} for state in measured["passes"]]


def rows_but(path, replaced):
    """Rows of a CSV file, if there is one, that `replaced` does not say of that they are made anew."""
    if not path.exists():
        return []
    with open(path, encoding="utf-8") as file:
        return [row for row in csv.DictReader(file) if not replaced(row)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--set", choices=tuple(RAYS), default="default")
    parser.add_argument("--methods", nargs="+", choices=[method.label for method in METHODS],
                        help="these only, by label; what OUT holds of other methods and scenes, and of references, stays")
    add_scene_options(parser)
    arguments = parser.parse_args()

    scenes = [{"small": small, "full": full}.get(arguments.set, lambda scene: scene)(scene)
              for scene in scenes_of(arguments)]
    arguments.out.mkdir(parents=True, exist_ok=True)
    references = References(arguments.references, RAYS[arguments.set], arguments.threads)

    start = time.monotonic()
    for scene in scenes:
        sizes = {setting.resolution for setting in chosen_settings(scene, arguments.methods)}
        for size in sizes if scene.exact is None else scene.resolutions[-1:]:
            references.picture(scene, size)
    print(f"references: {time.monotonic() - start:.0f} s", flush=True)
    start = time.monotonic()
    rows = [row for scene in scenes for row in measure(scene, arguments.methods, references, arguments.threads)]
    print(f"solves: {time.monotonic() - start:.0f} s", flush=True)
    if arguments.methods:
        names = [scene.name for scene in scenes]
        rows = rows_but(arguments.out / "accuracy.csv",
                        lambda row: row["scene"] in names and row["method"] in arguments.methods) + rows
    if not arguments.methods or not (arguments.out / "reference.csv").exists():
        of_references = [row for scene in scenes for sampling in REFERENCES for row in reference_rows(scene, references, sampling)]
        write_rows(arguments.out / "reference.csv", ("scene", "sampling", "wall_s", "cpu_s", "error"), of_references)
    write_rows(arguments.out / "accuracy.csv", FIELDS, rows)
    draw(arguments.out)
    write_table(arguments.out)


if __name__ == "__main__":
    main()
