#!/usr/bin/env python3
"""The three pictures of Debelov & Sattarov (no subdivision; 50 x 50 pixels; 70 x 70; theirs has a Gaussian filter), of
the construction in wood, beside the reference, with their errors.

    bench/accuracy/pictures.py bench/results/accuracy/three-pictures.png
"""

import os
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

from runs import References, compare, fluxel, load
from settings import ROOT, of_project

RAYS = 300_000_000
SHOWN = 200  # pixels a side of what has no resolution of its own
EXPOSURE = ("--exposure", "-1.7")  # [stops], the same for all four
PICTURES = (
    ("no subdivision", SHOWN, ("--subdivision", "uniform", "--max-edge", "1e9")),
    ("50 x 50", 50, ("--max-edge", "0.4")),
    ("70 x 70", 70, ("--max-edge", "0.4")),
)


def main(file):
    scene = of_project("construction-in-wood", (), ())
    references = References(ROOT / "build/references", RAYS, os.cpu_count())
    figure, panels = pyplot.subplots(1, 4, figsize=(16, 4.6))
    for axes, (words, size, options) in zip(panels, PICTURES):
        with tempfile.TemporaryDirectory() as folder:
            fluxel("solve", scene.file, "--method", "matrix", "--out", folder, "--resolution", f"{size}x{size}",
                   "--supersample", 1,
                   *EXPOSURE, *options)
            reference = references.picture(scene, size)
            error = compare(Path(folder) / "image.exr", reference / "reference.exr", Path(folder) / "compare")
            report = load(Path(folder) / "report.json")
            show(axes, Path(folder) / "image.png",
                 f"{words}\n{report['elements']} elements, {report['time_s']['total']:.1f} s, error {error['error']:.1%}")
    with tempfile.TemporaryDirectory() as folder:
        fluxel("reference", scene.file, "--only", "picture", "--out", folder, "--resolution", f"{SHOWN}x{SHOWN}",
               "--rays", RAYS, *EXPOSURE)
        measured = load(Path(folder) / "reference.json")["measured"]["picture"]
        show(panels[3], Path(folder) / "reference.png", f"reference by paths of light\n{measured['seconds']:.0f} s, "
             f"standard error {max(measured['relative_error_rgb']):.1%}")
    figure.tight_layout()
    figure.savefig(file, dpi=100, bbox_inches="tight")


def show(axes, picture, title):
    axes.imshow(pyplot.imread(picture), interpolation="nearest")
    axes.set_title(title, fontsize=11)
    axes.set_axis_off()


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
