#!/usr/bin/env python3
"""What the error of a radiosity picture is made of: the Cornell box against paths of light, one thing changed at a time.

    bench/accuracy/contributors.py [--resolution 256] [--rays 400000000]

prints a Markdown table of the errors of elements (area-weighted) and of pixels: sigma without the reference's noise,
bias, both over the mean, of the worst colour. Each mesh has its own reference of elements, kept in build/references.
"""

import argparse
import os
import sys
from pathlib import Path

sys.dont_write_bytecode = True

from runs import References, Solves, compare
from settings import ROOT, Method, Setting, of_project

# Words, options of the method, options of the mesh, share of the resolution.
CHANGES = (
    ("as it is", (), (), 1),
    ("form factor: tolerance 1e-4", ("--form-factor-tolerance", "1e-4"), (), 1),
    ("form factor: disc", ("--form-factor", "disc"), (), 1),
    ("form factor: point", ("--form-factor", "point"), (), 1),
    ("one ray a pair", ("--no-partial-visibility",), (), 1),
    ("solver: --tolerance 1e-4", ("--tolerance", "1e-4"), (), 1),
    ("unseen parts twice as coarse", (), ("--max-edge", "{coarse}"), 1),
    ("unseen parts half as coarse", (), ("--max-edge", "{fine}"), 1),
    ("half the resolution", (), (), 2),
)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--resolution", type=int, default=256)
    parser.add_argument("--rays", type=int, default=400_000_000)
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--references", type=Path, default=ROOT / "build/references")
    arguments = parser.parse_args()

    scene = of_project("cornell-box", (arguments.resolution,), ())
    references = References(arguments.references, arguments.rays, arguments.threads)
    print("| changed | elements | sigma of elements | bias | noise of the reference | sigma of pixels | bias | s |\n"
          "| --- | --- | --- | --- | --- | --- | --- | --- |", flush=True)
    with Solves(scene, arguments.threads) as solves:
        edge = None
        for words, method, mesh, share in sorted(CHANGES, key=lambda change: (change[3], change[2])):
            size = arguments.resolution // share
            edges = {} if edge is None else {"coarse": 2 * edge, "fine": edge / 2}
            mesh = tuple(part.format(**edges) for part in mesh)
            setting = Setting(Method(words, "camera", method), 0, size, (*mesh, "--resolution", f"{size}x{size}"))
            report = solves.run(setting)
            if report is None:
                print(f"| {words} | did not converge |", flush=True)
                continue
            edge = edge or report["subdivision"]["max_edge_m"]
            solution = solves.out / "solution.ply"
            of_elements = compare(solution, references.elements(scene, solution, report["hash"]["elements"])
                                  / "reference.ply", solves.folder / "compare")
            of_pixels = compare(solves.out / "image.exr", references.picture(scene, size) / "reference.exr",
                                solves.folder / "compare")
            print(f"| {words} | {report['elements']} | {percent(of_elements)} | {of_elements['bias']:+.3%} | "
                  f"{of_elements['noise']:.2%} | {percent(of_pixels)} | {of_pixels['bias']:+.3%} | "
                  f"{report['seconds']['wall'][0]:.1f} |", flush=True)


def percent(error):
    return f"{error['error']:.3%} ({error['low']:.3%} to {error['high']:.3%})"


if __name__ == "__main__":
    main()
