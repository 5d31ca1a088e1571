#!/usr/bin/env python3
"""Illuminance of an office under luminaires: a solve against Radiance's rtrace, as a Markdown table.

    FLUXEL=build/release/app/fluxel bench/office_radiance.py [--receivers desk around] [--passes 8] [--direct]

Needs Radiance's programs from the Python package pyradiance, and Python 3.11. All cells of the receivers that are grids are
measured. rtrace follows paths of light without ambient cache and super-samples, with a shadow ray to every source and with Russian
roulette (-aa 0 -as 0 -dt 0 -lr 0), since its faster ways are biased. Each pass has 16 points in every cell, spread evenly and
shifted at random, so that its mean is one over the cell; the spread of the passes is the noise.

Fluxel's luminaires are flat openings that hide nothing. In Radiance an area source absorbs the reflected light that meets its
front, and ies2rad gives it sides where the file has a height. Hence an opening is made of eight small spheres here, at the points
of Gauss's rule on its halves. --opening box takes the luminaires as ies2rad makes them, to show what that changes; --direct
compares the direct light alone, by both between black surfaces.

A value is told as `solve (its error) / rtrace (its noise)`.
"""

import argparse
import math
import os
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "python"))

try:
    import fluxel
    import numpy as np
    import pyradiance
except ImportError as error:
    print(f"{error}: bench/office_radiance.py needs numpy and pyradiance, as from pip install numpy pyradiance.", file=sys.stderr)
    sys.exit(2)

SCENE = ROOT / "scenes/office-luminaires/office-tasks.toml"
LUMENS_A_WATT = 179  # of Radiance
LUMINANCE = (0.2126, 0.7152, 0.0722)  # of red, green, blue (ITU-R BT.709), as receivers have it
RADIUS = 1e-3  # of a sphere [m]
POINTS = 16  # of a cell, in a pass
FIGURES = ("mean", "min", "max", "u0")


def run(folder, *command, **settings):
    """What a program of Radiance writes."""
    package = Path(pyradiance.__file__).parent
    environment = {**os.environ, "PATH": f"{package / 'bin'}:{os.environ['PATH']}", "RAYPATH": f".:{package / 'lib'}"}
    command = list(map(str, command))
    return subprocess.run(command, cwd=folder, env=environment, check=True, stdout=subprocess.PIPE, **settings).stdout


def surfaces(obj):
    """An OBJ file and its MTL file as Radiance's polygons of matt plastic."""
    corners, text, material = [], [], None
    for words in map(str.split, obj.read_text().splitlines()):
        if words[:1] == ["mtllib"]:
            for line in (obj.parent / words[1]).read_text().splitlines():
                name, *values = line.split() or [""]
                if name == "newmtl":
                    material = values[0]
                elif name == "Kd":
                    text.append(f"void plastic {material} 0 0 5 {' '.join(values)} 0 0\n")
        elif words[:1] == ["v"]:
            corners.append(" ".join(words[1:4]))
        elif words[:1] == ["usemtl"]:
            material = words[1]
        elif words[:1] == ["f"]:
            face = [corners[int(word.split("/")[0]) - 1] for word in words[1:]]
            text.append(f"{material} polygon face{len(text)} 0 0 {3 * len(face)} {' '.join(face)}\n")
    return "".join(text)


def opening(ies):
    """Length along C0 and width along C90 of the opening of an IES file without a tilt [m]."""
    numbers = ies.read_text().split("TILT=NONE")[1].split()
    width, length = float(numbers[7]), float(numbers[8])
    return [0.3048 * size if numbers[6] == "1" else size for size in (length, width)]


def luminaires(folder, table, kind):
    """The luminaires of a [[luminaires]] table that look down, C0 along x, as ies2rad has them."""
    assert table["aim"] == [0, 0, -1] and not {"turn", "flux", "size", "maintenance_factor"} & set(table)
    ies = SCENE.parent / table["file"]
    if kind == "box":
        run(folder, "ies2rad", "-t", "default", "-c", 1, 1, 1, "-o", "lamp", "-p", ".", ies)
        points = [(0, 0)]
    else:
        run(folder, "ies2rad", "-t", "default", "-c", 1, 1, 1, "-m", 1 / 8, "-i", RADIUS, "-o", "lamp", "-p", ".", ies)
        length, width = opening(ies)
        gauss = (-0.5 / math.sqrt(3), 0.5 / math.sqrt(3))
        points = [(length * (half + 0.5 * x), width * y) for half in (-0.25, 0.25) for x in gauss for y in gauss]
    text = b""
    for row in range(table["rows"]):
        for column in range(table["columns"]):
            middle = np.array(table["position"]) + row * np.array(table["row_step"]) + column * np.array(table["column_step"])
            for x, y in points:
                text += run(folder, "xform", "-t", middle[0] + x, middle[1] + y, middle[2], "lamp.rad")
    return text.decode()


def points_in_cells(centres, random):
    """Points spread evenly over each cell of a grid, shifted at random in each: (POINTS, rows, columns, 3)."""
    along, up = centres[0, 1] - centres[0, 0], centres[1, 0] - centres[0, 0]
    sequence = np.arange(POINTS)[:, None] * np.array([0.7548776662, 0.5698402910])  # R2
    place = (sequence[:, None, None] + random.uniform(size=(*centres.shape[:2], 2))) % 1 - 0.5
    return centres + place[..., :1] * along + place[..., 1:] * up


def trace(folder, points, options):
    """Illuminance [lx] at points of planes that look up."""
    rays = "".join("{:.6f} {:.6f} {:.6f} 0 0 1\n".format(*point) for point in points.reshape(-1, 3))
    out = run(folder, "rtrace", "-h", "-w", "-I", *options, "office.oct", text=True, input=rays)
    rgb = np.array([line.split() for line in out.splitlines()], dtype=float)
    return LUMENS_A_WATT * (rgb @ LUMINANCE).reshape(points.shape[:-1])


def black(folder):
    """The scene with black surfaces."""
    text = SCENE.read_text().replace('file = "', f'file = "{SCENE.parent}/')
    materials = "".join(Path(table["file"]).with_suffix(".mtl").read_text() for table in tomllib.loads(text)["geometry"])
    for line in materials.splitlines():
        if line.startswith("newmtl"):
            text += f"\n[materials.{line.split()[1]}]\nrho = 0.0\n"
    Path(folder, "black.toml").write_text(text)
    return Path(folder, "black.toml")


def figures(passes):
    """Mean, min, max, U0 of a receiver, and their noise, from (passes, rows, columns) illuminances."""
    count = len(passes)
    cells, noise = passes.mean(axis=0), passes.std(axis=0, ddof=1) / math.sqrt(count)
    mean, mean_noise = cells.mean(), passes.mean(axis=(1, 2)).std(ddof=1) / math.sqrt(count)
    low, high = np.unravel_index(cells.argmin(), cells.shape), np.unravel_index(cells.argmax(), cells.shape)
    U0 = cells[low] / mean
    return {"mean": (mean, mean_noise), "min": (cells[low], noise[low]), "max": (cells[high], noise[high]),
            "u0": (U0, U0 * math.hypot(noise[low] / cells[low], mean_noise / mean))}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--target-error", type=float, default=0.02)
    parser.add_argument("--passes", type=int, default=8)
    parser.add_argument("--divisions", type=int, default=16, help="rays of the hemisphere over a point (-ad)")
    parser.add_argument("--direct", action="store_true", help="direct light alone")
    parser.add_argument("--opening", choices=("spheres", "box"), default="spheres")
    parser.add_argument("--receivers", nargs="+", help="these alone")
    arguments = parser.parse_args()
    scene = tomllib.loads(SCENE.read_text())
    options = ["-ab", 0 if arguments.direct else 12, "-ad", arguments.divisions, "-as", 0, "-aa", 0, "-lr", 0, "-lw",
               1 / arguments.divisions, "-dt", 0, "-dj", 0, "-ds", 0.1]
    random = np.random.default_rng(1)
    with tempfile.TemporaryDirectory() as folder:
        solved = fluxel.solve(black(folder) if arguments.direct else SCENE, target_error=arguments.target_error)
        grids = {name: found for name, found in solved.receivers.items() if min(found.shape) > 1}
        text = "".join(surfaces(SCENE.parent / table["file"]) for table in scene["geometry"])
        text += "".join(luminaires(folder, table, arguments.opening) for table in scene["luminaires"])
        Path(folder, "office.rad").write_text(text)
        Path(folder, "office.oct").write_bytes(run(folder, "oconv", "office.rad"))
        print(f"rtrace {' '.join(map(str, options))}, {arguments.passes} passes.\n")
        print("| receiver | " + " | ".join(FIGURES) + " | ratio of means | RMS difference of cells |\n| --- |" + " ---: |" * 6)
        for name, receiver in grids.items():
            if arguments.receivers and name not in arguments.receivers:
                continue
            ours = receiver.values @ LUMINANCE
            passes = np.array([trace(folder, points_in_cells(receiver.centres, random), options).mean(axis=0)
                               for _ in range(arguments.passes)])
            theirs, stated = figures(passes), solved.report["receivers"][name]
            noise = np.sqrt((passes.var(axis=0, ddof=1) / arguments.passes).mean()) / theirs["mean"][0]
            rms = np.sqrt(np.mean((ours - passes.mean(axis=0)) ** 2)) / theirs["mean"][0]
            cells = [f"{stated[figure]['value']:.4g} ({stated[figure]['error']:.2g}) / {value:.4g} ({noise_of_it:.2g})"
                     for figure, (value, noise_of_it) in theirs.items()]
            cells += [f"{stated['mean']['value'] / theirs['mean'][0]:.4f}", f"{100 * rms:.2g} % (noise {100 * noise:.2g} %)"]
            print(f"| {name} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
