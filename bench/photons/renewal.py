#!/usr/bin/env python3
"""Selective photon tracing after a box has been moved in a hall: how many photons it concerns, and how soon the light is right.

  bench/photons/renewal.py HALL.obj --size x,y,z --at x,y,z --to x,y,z [--photons 4e6] [--max-edge 0.4] [--fluxel PROGRAM] [--ranks 1]

The light of the moved scene by as many photons is what errors are of: root mean squares over the mean irradiance of all
elements. A renewed photon goes twice, so that a fresh run of as many rays has twice as many photons as are renewed.
"""

import argparse
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "python"))
import fluxel  # noqa: E402

SHARES = (0.05, 0.1, 0.2, 0.4)
BOX = """mtllib box.mtl
v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1
g box\nusemtl box
f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8
"""


def numbers(text):
    return [float(word) for word in text.split(",")]


def areas(of):
    corners = of.vertices[of.faces.clip(min=0)]
    edges = [corners[:, k] - corners[:, 0] for k in (1, 2, 3)]
    halves = [np.linalg.norm(np.cross(edges[0], edges[1]), axis=1) / 2, np.linalg.norm(np.cross(edges[1], edges[2]), axis=1) / 2]
    return halves[0] + np.where(of.faces[:, 3] >= 0, halves[1], 0) if of.faces.shape[1] > 3 else halves[0]


def irradiance(file):
    """Of the elements' sides, in one colour, and their areas."""
    of = fluxel.read_elements(file)
    sides = [of.layers[name][:, 1] for name in ("irradiance", "irradiance_back") if name in of.layers]
    return np.concatenate(sides), np.concatenate([areas(of)] * len(sides))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("hall", type=Path)
    for name in ("size", "at", "to"):
        parser.add_argument(f"--{name}", type=numbers, required=True)
    parser.add_argument("--photons", type=float, default=4e6)
    parser.add_argument("--max-edge", default="0.4")
    parser.add_argument("--ranks", type=int, default=1)
    parser.add_argument("--fluxel", default=str(ROOT / "build/unity/app/fluxel"))
    options = parser.parse_args()
    photons = int(options.photons)

    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        (work / "box.obj").write_text(BOX)
        (work / "box.mtl").write_text("newmtl box\nKd 0.4 0.4 0.4\n")
        for name, place in (("before", options.at), ("after", options.to)):
            (work / f"{name}.toml").write_text(
                f'[[geometry]]\nfile = "{options.hall.resolve()}"\n[[geometry]]\nfile = "box.obj"\n'
                f"scale = {options.size}\ntranslate = {place}\n")

        def run(name, out, *arguments, codes=(0,)):
            program = [options.fluxel, "photons", work / f"{name}.toml", "--sequence", "halton", "--max-edge", options.max_edge,
                       "--no-cut", "--quiet", "--out", work / out, *arguments]
            if options.ranks > 1:
                program = ["mpirun", "-np", str(options.ranks), *program]
            job = subprocess.run([str(word) for word in program], capture_output=True, text=True)
            if job.returncode not in codes:
                sys.exit(job.stderr)
            return json.loads((work / out / "photons.json").read_text())

        before = run("before", "kept", "--photons", photons)
        tally = (work / "kept/photons.tally").read_bytes()
        run("after", "target", "--photons", photons)
        target, area = irradiance(work / "target/photons.ply")
        mean = (area * target).sum() / area.sum()
        error = lambda out: math.sqrt((area * (irradiance(work / out / "photons.ply")[0] - target)**2).sum() / area.sum()) / mean
        print(f"{photons} photons, {before['photons']['seconds']:.1f} s, {len(target)} sides, stated error "
              f"{100 * before['measured']['elements']['relative_error_rgb'][1]:.2f} %")
        renewed = run("after", "all", "--resume", "--changed-from", work / "before.toml", "--checkpoint", work / "kept")
        renewal = renewed["renewal"]
        same = (work / "kept/photons.tally").read_bytes() == (work / "target/photons.tally").read_bytes()
        print(f"all {renewal['groups']} groups: {renewed['photons']['seconds']:.1f} s, the tally is that of the new scene: {same}")
        pilots, last = renewal["turns"][0], renewal["turns"][-1]
        share = last["changed"] / last["renewed"]
        print(f"changed: {100 * share:.2f} % of all photons, {100 * pilots['changed'] / pilots['renewed']:.2f} % of the pilots; of groups as they come:")
        for turn in renewal["turns"][1::max(1, len(renewal["turns"]) // 12)]:
            of_groups = (turn["changed"] - pilots["changed"]) / (turn["renewed"] - pilots["renewed"])
            print(f"  {100 * turn['renewed'] / photons:5.1f} % of the photons: {100 * of_groups:.2f} %, {of_groups / share:.1f} times")
        print("error against the new scene's light, % of the mean: renewed, fresh of as many rays")
        for part in SHARES:
            (work / "kept/photons.tally").write_bytes(tally)
            run("after", "part", "--resume", "--changed-from", work / "before.toml", "--checkpoint", work / "kept", "--photons",
                int(part * photons), codes=(0, 3))
            run("after", "fresh", "--photons", int(2 * part * photons))
            print(f"  {100 * part:4.0f} %: {100 * error('part'):.3f}, {100 * error('fresh'):.3f}")


if __name__ == "__main__":
    main()
