#!/usr/bin/env python3
"""View factors of the squares of a cube's walls, empty or with a cube inside: time, memory and row sums of Fluxel, and of View3D beside it.

    FLUXEL=build/release/app/fluxel bench/view_factors/against_view3d.py cubes --view3d .../View3D

View3D (G. N. Walton, Calculation of obstructed view factors by adaptive integration, NISTIR 6925, 2002) is no part of this
project. Its makefile asks for no optimisation: gcc -O3 makes a program that is worth a comparison.
"""

import argparse
import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np


def wall_squares(half, squares, inwards):
    """Corners (walls * squares^2, 4, 3) of the squares of a cube about the origin, counter-clockwise about normals inwards or outwards."""
    steps = np.linspace(-half, half, squares + 1)
    u, v = (grid.ravel() for grid in np.meshgrid(range(squares), range(squares), indexing="ij"))
    found = []
    for axis in range(3):
        for end in (-half, half):
            corners = np.full((squares * squares, 4, 3), end)
            for k, (a, b) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
                corners[:, k, (axis + 1) % 3], corners[:, k, (axis + 2) % 3] = steps[u + a], steps[v + b]
            found.append(corners if (end > 0) != inwards else corners[:, ::-1])
    return np.concatenate(found)


def geometry(shape, squares):
    outer = wall_squares(1.5, squares, True)
    return outer if shape == "cube" else np.concatenate([outer, wall_squares(0.5, squares, False)])


def write_obj(file, faces):
    """Each face a group."""
    with open(file, "w", encoding="ascii") as out:
        for number, face in enumerate(faces):
            out.writelines(f"v {x:.17g} {y:.17g} {z:.17g}\n" for x, y, z in face)
            out.write(f"g s{number}\nf -4 -3 -2 -1\n")


def write_vs3(file, faces, eps):
    points, of_faces = np.unique(faces.reshape(-1, 3).round(12), axis=0, return_inverse=True)
    with open(file, "w", encoding="ascii") as out:
        out.write(f"T squares\nC encl=0 list=0 eps={eps:g}\nF 3\n")
        out.writelines(f"V {k + 1} {x:.12g} {y:.12g} {z:.12g}\n" for k, (x, y, z) in enumerate(points))
        # Its faces look to the side from which their corners go clockwise.
        for number, face in enumerate(of_faces.reshape(-1, 4)):
            out.write(f"S {number + 1} {' '.join(str(k + 1) for k in face)} 0 0 0.9 s{number}\n")
        out.write("End of data\n")


def measured(command, **options):
    """Wall time [s], processor time [s], largest resident memory [MB] of a command."""
    start = time.monotonic()
    process = subprocess.Popen([str(part) for part in command], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **options)
    _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        raise SystemExit(f"{command[0]} has failed")
    return time.monotonic() - start, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def fluxel_sums(folder):
    with np.load(folder / "view-factors.npz") as matrix:
        return np.add.reduceat(matrix["data"], matrix["indptr"][:-1].astype(np.int64))


def view3d_sums(file, count):
    rows = np.loadtxt(file, skiprows=2, max_rows=count)
    return rows.sum(axis=1)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("shape", choices=("cube", "cubes"), help="a cube, or a cube of side 1 in one of side 3")
    parser.add_argument("--squares", type=int, help="along an edge; default 14 for cube, 10 for cubes")
    parser.add_argument("--tolerance", default="0.001", help="of Fluxel")
    parser.add_argument("--view3d", help="its program, to be timed in turns with Fluxel")
    parser.add_argument("--eps", type=float, default=1e-4, help="of View3D")
    parser.add_argument("--turns", type=int, default=3, help="of which medians are taken")
    options = parser.parse_args()
    faces = geometry(options.shape, options.squares or (14 if options.shape == "cube" else 10))
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        write_obj(folder / "faces.obj", faces)
        write_vs3(folder / "faces.vs3", faces, options.eps)
        runs = {"fluxel": [Path(os.environ["FLUXEL"]).resolve(), "viewfactors", folder / "faces.obj", "--keep-polygons", "--sides", "one", "--threads", "1",
                           "--tolerance", options.tolerance, "--write", "npz", "--quiet", "--out", folder / "out"]}
        if options.view3d:
            runs["view3d"] = [Path(options.view3d).resolve(), folder / "faces.vs3", folder / "factors.txt"]
        found = {name: [] for name in runs}
        for _ in range(options.turns):
            for name, command in runs.items():
                found[name].append(measured(command, cwd=folder))
        sums = {"fluxel": fluxel_sums(folder / "out")}
        if options.view3d:
            sums["view3d"] = view3d_sums(folder / "factors.txt", len(faces))
        print("| program | faces | wall s | processor s | MB | largest row-sum error |\n| --- | --- | --- | --- | --- | --- |")
        for name, times in found.items():
            wall, processor, memory = (statistics.median(column) for column in zip(*times))
            print(f"| {name} | {len(faces)} | {wall:.2f} | {processor:.2f} | {memory:.0f} | {np.abs(sums[name] - 1).max():.1e} |")


if __name__ == "__main__":
    main()
