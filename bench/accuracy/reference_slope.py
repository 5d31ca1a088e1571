#!/usr/bin/env python3
"""How the error of `fluxel reference` falls with the number of rays, as a Markdown table.

    bench/accuracy/reference_slope.py [--fluxel PROGRAM] [--most-rays N]

Measured are the elements, the picture and a receiver in the Cornell box, with shadows and reflections, and two under a
lamp alone, where the light is smooth: a square metre, and cells so small that they are points. The slope is that of log
error on log rays, fitted to all sizes: -0.5 is what independent random numbers give.
"""

import argparse
import json
import math
import subprocess
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
CORNELL = ROOT / "scenes" / "cornell-box"
SIZES = 4  # each four times the one before

FLOOR = """
[[receivers]]
name = "in-the-box"
origin = [0.1, 0.001, 0.1]
u = [0, 0, 0.4]
v = [0.4, 0, 0]
cells = [4, 4]
"""
LAMP = """[[geometry]]
file = "lamp.obj"
[[receivers]]
name = "under-the-lamp"
origin = [0, 0, 0]
u = [1, 0, 0]
v = [0, 1, 0]
cells = [4, 4]
[[receivers]]
name = "points-under-the-lamp"
origin = [0.3, 0.2, 0]
u = [1e-6, 0, 0]
v = [0, 1e-6, 0]
cells = [4, 4]
[options]
sides = "one"
"""
LAMP_OBJ = "mtllib lamp.mtl\nv 0 0 1\nv 0 1 1\nv 1 1 1\nv 1 0 1\nusemtl lamp\nf 1 2 3 4\n"


def measured(fluxel, scene, folder, rays, *options):
    """{what: (rays, standard error over the mean)} of the green channel."""
    subprocess.run([fluxel, "reference", scene, "--rays", str(rays), "--sampling", "even", "--out", folder,
                    "--quiet", *options], check=True)
    report = json.loads((folder / "reference.json").read_text())["measured"]
    return {name: (of["rays"], of["relative_error_rgb"][1]) for name, of in report.items()}


def slope(points):
    """Of the straight line of least squares through the logarithms."""
    x, y = ([math.log(point[k]) for point in points] for k in (0, 1))
    mean_x, mean_y = sum(x) / len(x), sum(y) / len(y)
    return sum((a - mean_x) * (b - mean_y) for a, b in zip(x, y)) / sum((a - mean_x)**2 for a in x)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fluxel", default=ROOT / "build/release/app/fluxel")
    parser.add_argument("--most-rays", type=float, default=6e6)
    arguments = parser.parse_args()
    sizes = [int(arguments.most_rays / 4**k) for k in reversed(range(SIZES))]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "lamp.obj").write_text(LAMP_OBJ)
        (folder / "lamp.mtl").write_text("newmtl lamp\nKd 0 0 0\nKe 1 1 1\n")
        (folder / "lamp.toml").write_text(LAMP)
        text = (CORNELL / "cornell-box.toml").read_text().replace("cornell-box.obj", str(CORNELL / "cornell-box.obj"))
        box = folder / "box.toml"
        box.write_text(text + FLOOR)
        subprocess.run([arguments.fluxel, "solve", box, "--method", "matrix", "--subdivision", "uniform", "--max-edge",
                        "0.3", "--form-factor", "disc", "--out", folder / "solved", "--quiet"], check=True)
        points = {}
        for rays in sizes:
            found = measured(arguments.fluxel, box, folder / "out", rays, "--resolution", "16x16", "--elements",
                             folder / "solved" / "solution.ply")
            found |= measured(arguments.fluxel, folder / "lamp.toml", folder / "out", rays)
            for what, point in found.items():
                points.setdefault(what, []).append(point)
    print("| | " + " | ".join(f"{rays:.2g} rays" for rays in sizes) + " | slope |")
    print("| --- |" + " --- |" * (SIZES + 1))
    for what, of in points.items():
        cells = [f"{100 * error:.3g} %" for _, error in of]
        print(f"| {what} | {' | '.join(cells)} | {slope(of):.2f} |")


if __name__ == "__main__":
    main()
