"""Charts and panels of pictures."""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot
import numpy as np

from outcome import ROOT

sys.path.append(str(ROOT / "bench/visibility"))
from chart import COLOURS, MARKERS, fit

DPI = 90
__all__ = ["COLOURS", "MARKERS", "fit", "axes_of", "draw", "law", "reference_line", "save", "panels", "shown"]


def axes_of(x, y, title, log_x=True, log_y=True):
    figure, axes = pyplot.subplots(figsize=(7, 4.4), layout="constrained")
    axes.set_xlabel(x)
    axes.set_ylabel(y)
    axes.set_title(title, fontsize=11, loc="left")
    if log_x:
        axes.set_xscale("log")
    if log_y:
        axes.set_yscale("log")
    axes.grid(which="major", color="#D9D9D9", linewidth=0.6)
    axes.set_axisbelow(True)
    return figure, axes


def draw(axes, x, y, label, number, line="-"):
    axes.plot(x, y, line, marker=MARKERS[number], color=COLOURS[number], label=label)


def law(x, y):
    """The power of x that y grows as."""
    return fit(np.asarray(x, float), np.asarray(y, float))[1]


def reference_line(axes, x, y, power, label):
    """A line of that power through (x[0], y[0])."""
    ends = np.array([min(x), max(x)], float)
    axes.plot(ends, y[0] * (ends / x[0]) ** power, ":", color="#555555", linewidth=1.2, label=label)


def ticks(axes, values):
    axes.set_xticks(values, [str(value) for value in values])
    axes.set_xticks([], minor=True)


def save(figure, axes, path):
    axes.legend(fontsize=8, frameon=False)
    figure.savefig(path, dpi=DPI)
    pyplot.close(figure)


def shown(radiance, white):
    """As a display shows it: `white` [W/(m2 sr)] and above are white."""
    return np.clip(radiance / white, 0, 1) ** (1 / 2.2)


def panels(pictures, path, rows=1, size=2.9):
    """Pictures [(title, image)] beside each other."""
    across = -(-len(pictures) // rows)
    figure, places = pyplot.subplots(rows, across, figsize=(size * across, (size + 0.5) * rows), layout="constrained",
                                     squeeze=False)
    for axes in places.flat:
        axes.set_axis_off()
    for axes, (title, image) in zip(places.flat, pictures):
        axes.imshow(image, interpolation="nearest")
        axes.set_title(title, fontsize=9)
    figure.savefig(path, dpi=DPI)
    pyplot.close(figure)
