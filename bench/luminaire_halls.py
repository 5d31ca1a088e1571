#!/usr/bin/env python3
"""Halls of many luminaires: time, stated and true error of a solve.

    bench/luminaire_halls.py [--fluxel FILE] [--counts 12 48 ...] [--target-error 0.02] [--reference-seconds 60] [--out DIR]

Each luminaire has 6 m2 of the floor and hangs 0.5 m below the ceiling, at 3.5 m: the photometric file of the repository,
with its opening of 1.23 x 0.26 m and as a point. The true error is that of the picture, the worst colour's, against
`fluxel reference`, of the points in the middle of the pixels: spots on the ceiling are smaller than far pixels. Prints a
table in Markdown.
"""

import argparse
import sys
import warnings
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.append(str(ROOT / "python"))

import fluxel

SPACING = (2.4, 2.5)  # [m]
HEIGHT, BELOW = 4, 0.5  # [m]

FACES = {"floor": [(0, 1, 3, 2)], "ceiling": [(4, 6, 7, 5)],
         "wall": [(0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]}
REFLECTANCES = {"floor": 0.2, "ceiling": 0.7, "wall": 0.5}


def write_hall(folder, count, as_points):
    """The scene file of a hall of `count` luminaires in rows."""
    rows = max(k for k in range(1, int(count**0.5) + 1) if count % k == 0)
    columns = count // rows
    size = (columns * SPACING[0], rows * SPACING[1], HEIGHT)
    folder.mkdir(parents=True, exist_ok=True)
    corners = [[size[axis] * (number >> axis & 1) for axis in range(3)] for number in range(8)]
    (folder / "hall.mtl").write_text("".join(f"newmtl {name}\nKd {rho} {rho} {rho}\n" for name, rho in REFLECTANCES.items()))
    (folder / "hall.obj").write_text(
        "mtllib hall.mtl\n" + "".join("v {:g} {:g} {:g}\n".format(*corner) for corner in corners) +
        "".join(f"usemtl {name}\nf {' '.join(str(k + 1) for k in face)}\n" for name, faces in FACES.items() for face in faces))
    scene = folder / ("points.toml" if as_points else "openings.toml")
    scene.write_text(f"""units = "photometric"
[[geometry]]
file = "hall.obj"
[[luminaires]]
name = "lamp"
file = "{ROOT}/scenes/luminaires/ledalite-apex55.ies"
position = [{SPACING[0] / 2}, {SPACING[1] / 2}, {HEIGHT - BELOW}]
aim = [0, 0, -1]
rows = {rows}
columns = {columns}
row_step = [0, {SPACING[1]}, 0]
column_step = [{SPACING[0]}, 0, 0]
{"size = 0" if as_points else ""}
[camera]
eye = [0.5, 0.5, 1.6]
look_at = [{0.8 * size[0]}, {0.7 * size[1]}, 1.2]
up = [0, 0, 1]
fov = 70
resolution = [320, 240]
""")
    return scene


def measure(scene, options):
    """A row of the table."""
    program, folder = options.fluxel, scene.parent / f"{scene.stem}-reference"
    solution = fluxel.solve(scene, out=scene.parent / scene.stem, executable=program, target_error=options.target_error,
                            supersample=1, threads=2)
    report = solution.report
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", fluxel.NotReachedWarning)  # its time is over
        truth = fluxel.reference(scene, out=folder, executable=program, only="picture", time=options.reference_seconds,
                                 supersample=1, threads=2)
    off = fluxel.compare(solution.out / "image.exr", truth.out / "reference.exr", executable=program, out=folder / "compare")
    colours = off.report["colours"].values()
    worst = max((colour["noise_free"] for colour in colours), key=lambda free: free["sigma_relative"])
    true = "{:.2f} % ({:.2f} to {:.2f})".format(
        *(100 * worst[name] for name in ("sigma_relative", "sigma_low_relative", "sigma_high_relative")))
    return [f"{report['time_s']['total']:.1f}", str(len(report["hierarchy"]["rounds"])), f"{100 * report['stated_error']:.2f} %",
            true]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fluxel", default=str(ROOT / "build/release/app/fluxel"))
    parser.add_argument("--counts", type=int, nargs="+", default=[12, 48, 120, 500])
    parser.add_argument("--target-error", type=float, default=0.02)
    parser.add_argument("--reference-seconds", type=float, default=60)
    parser.add_argument("--out", type=Path, default=Path("out/halls"))
    options = parser.parse_args()
    print("| luminaires | as | whole run [s] | rounds | stated error | true error |\n| ---: | --- | ---: | ---: | ---: | --- |")
    for count in options.counts:
        for as_points in (True, False):
            scene = write_hall(options.out / str(count), count, as_points)
            row = measure(scene, options)
            print("| " + " | ".join([str(count), "points" if as_points else "openings", *row]) + " |", flush=True)


if __name__ == "__main__":
    main()
