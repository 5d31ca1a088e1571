#!/usr/bin/env python3
"""What inversion and the re-use of numbers save: photons on the plate under glass of Dmitriev 2002, figure 1.

  bench/photons/glass.py [--bench build/unity/bench/photons/photons_bench] [--out DIR]

True errors of 32 x 32 cells against the quadrature of plate_under_glass.py, of emission by rejection, by inversion, and by
inversion with the re-use of what choices leave, and of random numbers; writes glass.csv and, with matplotlib, glass.png.
"""

import argparse
import csv
import io
import math
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.append(str(Path(__file__).resolve().parent))
sys.path.append(str(ROOT / "python"))
import fluxel  # noqa: E402
from plate_under_glass import cell_means, scene  # noqa: E402

VARIANTS = {"random": "random numbers", "sobol-rejection": "rejection", "sobol-no-reuse": "inversion",
            "sobol": "inversion and re-use"}
PHOTONS = [1 << k for k in range(14, 23)]
PAPER = {"sobol-rejection": 5.52, "sobol-no-reuse": 2.99, "sobol": 1.91}  # %, of 2^20 photons


def measured(bench, variant, cells):
    """{photons: cells of the plate}, and the coordinates of a photon."""
    edge = scene.PLATE_EDGE
    job = subprocess.run([bench, "cells", str(ROOT / "scenes/plate-under-glass/plate-under-glass.toml"),
                          str(1.0001 * edge / cells), variant, *map(str, PHOTONS)], check=True, capture_output=True, text=True)
    found = defaultdict(lambda: np.zeros((cells, cells)))
    for row in csv.DictReader(io.StringIO(job.stdout)):
        x, y, z = (float(row[axis]) for axis in "xyz")
        if abs(z) < 1e-6:
            found[int(row["photons"])][int((y / edge + 0.5) * cells), int((x / edge + 0.5) * cells)] = float(row["irradiance"])
    return found, float(job.stderr.split()[1])


def uncertain_cells(program, exact, cells):
    """How many errors each cell is off, of scrambled points, which know the error of each."""
    with tempfile.TemporaryDirectory() as out:
        subprocess.run([program, "photons", ROOT / "scenes/plate-under-glass/plate-under-glass.toml", "--max-edge",
                        str(1.0001 * scene.PLATE_EDGE / cells), "--sequence", "scrambled", "--photons", str(1 << 22), "--quiet",
                        "--out", out], check=True)
        of = fluxel.read_elements(Path(out) / "photons.ply")
    middles = of.vertices[of.faces[:, :4]].mean(axis=1)
    plate = np.abs(middles[:, 2]) < 1e-6
    place = ((middles[plate, :2] / scene.PLATE_EDGE + 0.5) * cells).astype(int)
    layers = {name: of.layers[name][plate, 1] for name in ("irradiance", "irradiance_error")}
    return np.abs(layers["irradiance"] - exact[place[:, 1], place[:, 0]]) / layers["irradiance_error"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--bench", default=str(ROOT / "build/unity/bench/photons/photons_bench"))
    parser.add_argument("--fluxel", default=str(ROOT / "build/unity/app/fluxel"))
    parser.add_argument("--out", type=Path, default=Path("photons-glass"))
    options = parser.parse_args()
    options.out.mkdir(parents=True, exist_ok=True)
    cells = scene.CELLS
    exact, _ = cell_means(cells)
    errors, coordinates = {}, {}
    for variant in VARIANTS:
        found, coordinates[variant] = measured(options.bench, variant, cells)
        errors[variant] = [float(np.sqrt(np.mean((found[count] - exact)**2)) / exact.mean()) for count in PHOTONS]
    with open(options.out / "glass.csv", "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["photons", *VARIANTS])
        for k, count in enumerate(PHOTONS):
            writer.writerow([count, *(f"{errors[variant][k]:.6g}" for variant in VARIANTS)])
    at = PHOTONS.index(1 << 20)
    for variant, name in VARIANTS.items():
        slope = np.polyfit(np.log(PHOTONS), np.log(errors[variant]), 1)[0]
        print(f"{name:22} {coordinates[variant]:.2f} coordinates, error of 2^20 photons {100 * errors[variant][at]:.3f} %, "
              f"slope {slope:.2f}; paper {PAPER.get(variant, math.nan)} %")
    print(f"rejection over inversion {errors['sobol-rejection'][at] / errors['sobol-no-reuse'][at]:.2f} (paper 1.85), "
          f"over inversion and re-use {errors['sobol-rejection'][at] / errors['sobol'][at]:.2f} (paper 2.89)")
    off = uncertain_cells(options.fluxel, exact, cells)
    print(f"scrambled, 2^22 photons: within one error {100 * (off < 1).mean():.1f} % of the cells (66.7 % are expected), within two "
          f"{100 * (off < 2).mean():.1f} % (93.6 %), within three {100 * (off < 3).mean():.1f} % (99.1 %)")
    try:
        import matplotlib
    except ImportError:
        return
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure, axis = plt.subplots(figsize=(6.5, 4.5))
    for variant, name in VARIANTS.items():
        axis.loglog(PHOTONS, [100 * e for e in errors[variant]], "o-", ms=4, label=name)
    axis.set(xlabel="photons", ylabel="error of 32 x 32 cells [% of the mean]", title="plate under glass")
    axis.grid(True, which="both", alpha=0.3)
    axis.legend()
    figure.tight_layout()
    figure.savefig(options.out / "glass.png", dpi=110)


if __name__ == "__main__":
    main()
