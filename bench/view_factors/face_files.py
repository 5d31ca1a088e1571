#!/usr/bin/env python3
"""View factors between the 1,176 faces of a cube seen from inside: written as an array of NumPy and read back, over computing them.

    FLUXEL=build/release/app/fluxel bench/view_factors/face_files.py
"""

import os
import statistics
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

SQUARES, TURNS = 14, 5  # a side of the cube along each edge; of which medians are taken


def cube():
    """OBJ, normals inwards."""
    lines, corners = ["g room"], 0
    for axis in range(3):
        for end in (0, 1):
            for i in range(SQUARES):
                for j in range(SQUARES):
                    square = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)][::-1 if end else 1]
                    for x, y in square:
                        place = {axis: end, (axis + 1) % 3: x / SQUARES, (axis + 2) % 3: y / SQUARES}
                        lines.append("v " + " ".join(f"{place[k]:.17g}" for k in range(3)))
                    lines.append("f " + " ".join(str(corners + k) for k in (1, 2, 3, 4)))
                    corners += 4
    return "\n".join(lines) + "\n"


def main():
    with tempfile.TemporaryDirectory() as folder:
        scene, out = Path(folder) / "cube.obj", Path(folder) / "out"
        scene.write_text(cube())

        def seconds(*options):
            start = time.monotonic()
            subprocess.run([os.environ["FLUXEL"], "viewfactors", scene, "--keep-polygons", "--sides", "one", "--quiet", "--out", out, *options],
                           check=True, capture_output=True)
            return time.monotonic() - start

        times = []
        for _ in range(TURNS):
            without, written = seconds(), seconds("--write", "npy")
            start = time.monotonic()
            factors = np.load(out / "view-factors.npy")
            total = factors["view_factor"].sum()
            times.append((without, written, time.monotonic() - start))
        without, written, read = map(statistics.median, zip(*times))
        print(f"{without:.3f} s, with the file {written:.3f} s ({len(factors)} entries that sum to {total:.3f}), read in {read:.3f} s: "
              f"{(written + read) / without:.2f} times")


if __name__ == "__main__":
    main()
