#!/usr/bin/env python3
"""How far a light map is off: its radiosity, averaged over each element of the solve, against paths of light.

    FLUXEL=build/release/app/fluxel bench/light_map.py scenes/cornell-box/cornell-box.toml --texel 0.004 [--target-error 0.03]
        [--seconds 120] [--out out/light-map]

Of scenes whose faces have one side each.
"""

import argparse
import math
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "python"))

import fluxel

POINTS = 32  # of each element, in two halves whose difference tells their noise


def random_points(elements, random):
    """(POINTS, elements, 3), by area."""
    faces = elements.faces
    corner = [elements.vertices[faces[:, k]] for k in range(3)]
    a, b = random.random((2, POINTS, len(faces), 1))
    is_parallelogram = (faces[:, 3:] >= 0).any(axis=1)[:, None] if faces.shape[1] > 3 else np.zeros((len(faces), 1), bool)
    outside = (a + b > 1) & ~is_parallelogram
    a, b = np.where(outside, 1 - a, a), np.where(outside, 1 - b, b)
    # From the second corner, between the first and the third.
    return corner[1] + a * (corner[0] - corner[1]) + b * (corner[2] - corner[1])


def places_of(light_map, points, normals):
    """Of points (n, 3) of surfaces that face along normals (n, 3): (n, 2) places in the map."""
    first, u, v = (light_map.corners[:, 0], light_map.corners[:, 1] - light_map.corners[:, 0],
                   light_map.corners[:, 2] - light_map.corners[:, 0])
    normal = np.cross(u, v)
    area = np.linalg.norm(normal, axis=1)
    normal /= area[:, None]
    places, missed = np.full((len(points), 2), np.nan), np.full(len(points), 1e-4)
    for k in range(len(first)):
        near = np.flatnonzero((normals @ normal[k] > 0.999) & (abs((points - first[k]) @ normal[k]) < 1e-5))
        way = points[near] - first[k]
        s, t = np.cross(way, v[k]) @ normal[k] / area[k], np.cross(u[k], way) @ normal[k] / area[k]
        outside = np.maximum(0, np.maximum(np.maximum(-s, -t), s + t - 1))
        better = outside < missed[near]
        missed[near[better]] = outside[better]
        weights = np.stack([1 - s - t, s, t], axis=1)[better]
        places[near[better]] = weights @ light_map.places[k]
    return places


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", type=Path)
    parser.add_argument("--texel", type=float)
    parser.add_argument("--target-error", type=float, default=0.03)
    parser.add_argument("--seconds", type=float, default=120, help="of the reference")
    parser.add_argument("--out", type=Path, default=Path("out/light-map"))
    arguments = parser.parse_args()
    start = time.monotonic()
    solution = fluxel.solve(arguments.scene, out=arguments.out, target_error=arguments.target_error, error_of="surfaces", write="lightmap",
                            lightmap_texel=arguments.texel)
    seconds = time.monotonic() - start
    truth = fluxel.reference(arguments.scene, out=arguments.out / "reference", elements=arguments.out / "solution.ply", only="elements",
                             target_error=0.002, time=arguments.seconds)
    elements, true, light_map = solution.elements, truth.elements, solution.light_map
    points = random_points(elements, np.random.default_rng(1))
    places = places_of(light_map, points.reshape(-1, 3), np.tile(elements.normals, (POINTS, 1)))
    found = ~np.isnan(places).any(axis=1)
    B = np.zeros((len(found), 3))
    B[found] = math.pi * light_map.light(places[found])
    count = found.reshape(POINTS, -1).sum(axis=0)
    halves = B.reshape(2, POINTS // 2, -1, 3).sum(axis=1) / np.maximum(1, found.reshape(2, POINTS // 2, -1).sum(axis=1))[..., None]
    B = halves.mean(axis=0)
    areas = elements.areas * (count > 0)
    mean = areas @ true.radiosity / areas.sum()
    noise = areas @ (true.error**2 + ((halves[0] - halves[1]) / 2) ** 2) / areas.sum()
    squares = areas @ (B - true.radiosity) ** 2 / areas.sum()
    told = solution.report["light_map"]
    print(f"{told['width']} x {told['height']} texels of {1000 * told['texel_m']:.3g} mm, {told['points']} points, {told['charts']} charts, "
          f"{seconds:.0f} s with the solve")
    print(f"stated error of the surfaces {100 * solution.stated_error:.2g} %, noise of the map {100 * told['noise']:.2g} %")
    print(f"off by {100 * max(np.sqrt(np.maximum(0, squares - noise)) / mean):.2g} % (root mean square over {(count > 0).mean():.1%} of the "
          f"elements; {100 * max(np.sqrt(squares) / mean):.2g} % with the noise of the reference and of these points); bias "
          + ", ".join(f"{100 * value:+.2g}" for value in (areas @ (B - true.radiosity) / areas.sum() / mean)) + " % of red, green, blue")


if __name__ == "__main__":
    main()
