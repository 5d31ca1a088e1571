#!/usr/bin/env python3
"""The chart of speed against accuracy, from the CSV files that accuracy.py has written.

    bench/accuracy/chart.py bench/results/accuracy

draws FOLDER/accuracy-wall and FOLDER/accuracy-cpu, as PNG and SVG.
"""

import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot

from curves import REFERENCES, VIEW, pareto, read
from settings import METHODS, SCENES

# Okabe & Ito's palette, a grey and a wine red, told apart with any colour vision.
COLOURS = ("#7F7F7F", "#E69F00", "#D55E00", "#56B4E9", "#CC79A7", "#0072B2", "#000000", "#882255", "#009E73", "#332288")
MARKERS = ("X", "s", "^", "D", "v", "o", "*", "P", "h", "d")
COLUMNS = 2


def label(count):
    return f"{count / 1000:.1f}k" if count >= 1000 else str(count)


def draw_scene(axes, name, methods, kind):
    front = pareto({method: points for method, points in methods.items() if method not in (VIEW, *REFERENCES.values())})
    axes.plot([p.seconds for p in front], [100 * p.error for p in front], color="#FFF0A0", linewidth=6, zorder=0,
              solid_capstyle="round", label="best so far (Pareto front)")
    for method, colour, marker in zip(METHODS, COLOURS, MARKERS):
        points = methods.get(method.label, [])
        if not points:
            continue
        seconds, errors = [p.seconds for p in points], [100 * p.error for p in points]
        bars = [[100 * (p.error - p.low) for p in points], [100 * (p.high - p.error) for p in points]]
        axes.errorbar(seconds, errors, yerr=bars, color=colour, marker=marker, markersize=6, capsize=2, linewidth=1.5,
                      label=method.label + (", without its solve" if method.is_view else ""))
        if "disc" not in method.label:
            for point in points:
                axes.annotate(label(point.elements), (point.seconds, 100 * point.error), fontsize=7, color=colour,
                              xytext=(4, 4), textcoords="offset points")
    for (sampling, curve), style in zip(REFERENCES.items(), (":", "--")):
        reference = methods.get(curve, [])
        if reference:
            axes.plot([p.seconds for p in reference], [100 * p.error for p in reference], color="black", linestyle=style,
                      linewidth=1.5, label=f"paths of light, {sampling}: own standard error")
    exact = next((scene.exact for scene in SCENES if scene.name == name), None)
    of = "the picture" if exact is None else "the elements, against the exact value"
    axes.set(title=name, xscale="log", yscale="log", xlabel=f"{kind} time [s]",
             ylabel=f"error of {of}, rms [% of the mean]")
    axes.grid(which="major", color="#CCCCCC", linewidth=0.6)
    axes.grid(which="minor", color="#EEEEEE", linewidth=0.4)


def draw(folder):
    for kind, words in (("wall", "wall-clock"), ("cpu", "processor")):
        scenes = read(folder, kind)
        rows = -(-len(scenes) // COLUMNS)
        figure, panels = pyplot.subplots(rows, COLUMNS, figsize=(7.2 * COLUMNS, 5.2 * rows), squeeze=False)
        for axes in panels.flat[len(scenes):]:
            axes.set_axis_off()
        for axes, (name, methods) in zip(panels.flat, scenes.items()):
            draw_scene(axes, name, methods, words)
        handles = {}
        for axes in panels.flat:
            handles.update({name: handle for handle, name in zip(*axes.get_legend_handles_labels())})
        figure.legend(handles.values(), handles.keys(), loc="lower center", ncols=4, fontsize=9)
        figure.tight_layout(rect=(0, 0.05 if rows > 1 else 0.12, 1, 1))
        for suffix in ("png", "svg"):
            figure.savefig(Path(folder) / f"accuracy-{kind}.{suffix}", dpi=110)
        pyplot.close(figure)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    draw(sys.argv[1])
