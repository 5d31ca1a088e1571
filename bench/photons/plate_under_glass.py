#!/usr/bin/env python3
"""Exact illuminance of the plate of scenes/plate-under-glass, the mean of each of n x n squares.

    bench/photons/plate_under_glass.py [n]

Light of a point luminaire comes to the plate through a slab of glass whose faces are parallel to it. A ray at an angle
gamma to the axis leaves the slab parallel to itself; after m pairs of reflections within the slab, of thickness d, it
meets the plate, which is a distance h from the luminaire, at the radius

    r_m(gamma) = (h - d) tan(gamma) + (2 m + 1) d tan(gamma'),    sin(gamma) = n sin(gamma')    (Snell)

with the share T_m = (1 - R)^2 R^(2 m) of its power, where R is the mean of Fresnel's reflectances of both polarisations:
each face is met by unpolarised light. The flux I(C, gamma) T_m sin(gamma) d gamma dC falls on r dr dC, so that

    illuminance(r, C) = sum over m of T_m I(C, gamma_m) sin(gamma_m) / (r dr_m / d gamma).

A square's flux is the integral of this over it. With F(C, r) its integral over the radius from the axis on, which is
F = sum over m of the integral of I T_m sin(gamma) over gamma up to where r_m = r, Green's theorem makes it a line integral
of F dC around the square. I is bilinear between the table's angles, as in scene/intensity_table.hpp, so F is linear in C
between the table's planes and smooth between circles r_m(gamma of the table): there the lines are cut for Gauss's rule.

Nothing else comes to the plate. The luminaire sends nothing beyond 45 degrees, which is within the slab's upper face; light
has been reflected at least `reflections_to_side()` times within the slab before it meets a side face, and `side_share()` is a
bound of the share of all light that does. The plate is black and all else is open: what goes up never returns.
"""

import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.dont_write_bytecode = True
sys.path.append(str(ROOT / "scripts"))

from scene_parts import plate_under_glass as scene

LEAST_SHARE = 1e-16  # of a ray's power: more reflections do not count
ORDERS = (10, 16)  # of Gauss's rule; the difference is the estimate of the error
INNER_ORDER = 12  # along gamma, within a cell of the table


@dataclass(frozen=True)
class Slab:
    """A point luminaire, a plate that far below it, and between them glass."""

    distance: float = scene.SOURCE_HEIGHT
    thickness: float = scene.SLAB_HIGH - scene.SLAB_LOW
    index: float = scene.REFRACTION_INDEX

    def behind(self, gamma):
        """The sine and cosine of the angle within the glass."""
        sine = np.sin(gamma) / self.index
        return sine, np.sqrt(1 - sine * sine)

    def radius(self, gamma, m):
        """Where a ray meets the plate [m], and the derivative of that by gamma."""
        sine, cosine = self.behind(gamma)
        air, glass = self.distance - self.thickness, (2 * m + 1) * self.thickness
        slope = np.cos(gamma) / (self.index * cosine)  # d gamma' / d gamma
        return air * np.tan(gamma) + glass * sine / cosine, air / np.cos(gamma) ** 2 + glass * slope / cosine**2

    def reflectance(self, gamma):
        """Of each face, from within as from without."""
        outside = np.cos(gamma)
        inside = self.behind(gamma)[1]
        across = (outside - self.index * inside) / (outside + self.index * inside)
        along = (self.index * outside - inside) / (self.index * outside + inside)
        return 0.5 * (across * across + along * along)

    def share(self, gamma, m):
        R = self.reflectance(gamma)
        return (1 - R) ** 2 * R ** (2 * m)

    def gamma_at(self, radius, m):
        """The angle of the ray that meets the plate there: Newton's method, from below, where r_m is convex."""
        gamma = np.arctan(radius / self.distance) / (1 + 2 * m)
        for _ in range(60):
            r, slope = self.radius(gamma, m)
            step = np.clip((radius - r) / slope, -0.2, 0.2)
            gamma = np.clip(gamma + step, 0.0, 1.5)
            if np.max(np.abs(step), initial=0.0) < 1e-15:
                break
        return gamma


@dataclass(frozen=True)
class Table:
    """Intensities [cd] at angles [rad], a row for each C, from 0 to a whole turn."""

    C: np.ndarray
    gamma: np.ndarray
    intensity: np.ndarray


def scene_table():
    intensity = [[scene.intensity(C, gamma) for gamma in scene.GAMMAS] for C in scene.C_ANGLES]
    return Table(np.radians(scene.C_ANGLES), np.radians(scene.GAMMAS), np.array(intensity))


def unit_rule(order):
    """Gauss's rule on [0, 1]."""
    nodes, weights = np.polynomial.legendre.leggauss(order)
    return 0.5 * (nodes + 1), 0.5 * weights


class PlaneFlux:
    """F, the flux between the axis and a radius per angle about the axis [lm/rad]."""

    def __init__(self, slab, table):
        self.slab, self.table = slab, table
        R = float(np.max(slab.reflectance(table.gamma)))
        self.orders = range(max(1, math.ceil(math.log(LEAST_SHARE) / (2 * math.log(R)))) if R > 0 else 1)
        self.whole = [self._whole(m) for m in self.orders]

    def _part(self, cells, upto, m):
        """The integral over gamma from the start of each cell of the table up to an angle within it, a row for each C."""
        start = self.table.gamma[cells]
        width = self.table.gamma[cells + 1] - start
        low, high = self.table.intensity[:, cells], self.table.intensity[:, cells + 1]
        total = np.zeros_like(low)
        for node, weight in zip(*unit_rule(INNER_ORDER)):
            gamma = start + node * (upto - start)
            part = weight * (upto - start) * self.slab.share(gamma, m) * np.sin(gamma)
            total = total + part * (low + (gamma - start) / width * (high - low))
        return total

    def _whole(self, m):
        """The integral over gamma up to each angle of the table."""
        cells = np.arange(self.table.gamma.size - 1)
        parts = self._part(cells, self.table.gamma[1:], m)
        return np.concatenate([np.zeros((self.table.C.size, 1)), np.cumsum(parts, axis=1)], axis=1)

    def __call__(self, C, radius):
        """At many places; C within 0 to a whole turn."""
        planes = np.clip(np.searchsorted(self.table.C, C, side="right") - 1, 0, self.table.C.size - 2)
        fraction = (C - self.table.C[planes]) / (self.table.C[planes + 1] - self.table.C[planes])
        places = np.arange(radius.size)
        total = np.zeros(radius.size)
        for m, whole in zip(self.orders, self.whole):
            gamma = np.minimum(self.slab.gamma_at(radius, m), self.table.gamma[-1])
            cells = np.clip(np.searchsorted(self.table.gamma, gamma, side="right") - 1, 0, self.table.gamma.size - 2)
            sums = whole[:, cells] + self._part(cells, gamma, m)
            total += (1 - fraction) * sums[planes, places] + fraction * sums[planes + 1, places]
        return total

    def illuminance(self, x, y):
        """At points of the plate off the axis [lx]."""
        x, y = np.asarray(x, float), np.asarray(y, float)
        radius, C = np.hypot(x, y), np.arctan2(y, x) % (2 * np.pi)
        total = np.zeros(radius.size)
        for m in self.orders:
            gamma = self.slab.gamma_at(radius, m)
            planes = np.array([np.interp(gamma, self.table.gamma, row, right=0.0) for row in self.table.intensity])
            I = np.array([np.interp(c, self.table.C, column) for c, column in zip(C, planes.T)])
            total += self.slab.share(gamma, m) * I * np.sin(gamma) / (radius * self.slab.radius(gamma, m)[1])
        return total


def cuts_of_line(offset, lines, planes, circles):
    """Where the line y = offset crosses grid lines x, half planes of constant C through the origin, and circles."""
    low, high = lines[0], lines[-1]
    cuts = list(lines)
    if offset != 0:
        cuts += [offset * math.cos(C) / math.sin(C) for C in planes if math.sin(C) * offset > 0]
    for circle in circles:
        if circle > abs(offset):
            x = math.sqrt(circle * circle - offset * offset)
            cuts += [-x, x]
    cuts = np.unique(np.clip(cuts, low, high))
    return cuts[np.concatenate([[True], np.diff(cuts) > 1e-14 * (high - low)])]


def flux_along(F, offset, lines, circles, order, turn):
    """The integrals of F dC along y = offset, between every two of the lines x; `turn` [rad] is from these axes to the
    table's: 0 for lines along x, a right angle for such along y."""
    planes = np.unique(np.mod(F.table.C - turn, 2 * np.pi))
    cuts = cuts_of_line(offset, lines, planes, circles)
    nodes, weights = unit_rule(order)
    start, length = cuts[:-1, None], np.diff(cuts)[:, None]
    x = (start + length * nodes).ravel()
    squared = x * x + offset * offset
    value = F(np.mod(np.arctan2(offset, x) + turn, 2 * np.pi), np.sqrt(squared)) * -offset / squared  # dC = -y dx / r^2
    pieces = (value.reshape(-1, order) * weights * length).sum(axis=1)
    cells = np.searchsorted(lines, cuts[:-1] + 0.5 * length[:, 0]) - 1
    return np.bincount(cells, weights=pieces, minlength=len(lines) - 1)


def grid_means(F, lines, order):
    """Mean illuminance of the squares between the lines, [row, column]: rows along y, columns along x [lx]."""
    count, edge = len(lines) - 1, lines[1] - lines[0]
    circles = [float(F.slab.radius(gamma, m)[0]) for gamma in F.table.gamma[1:] for m in F.orders[:3]]
    along_x = np.array([flux_along(F, y, lines, circles, order, 0.0) for y in lines])  # [line, column]
    # The axes turned by a right angle: x' = y, y' = -x.
    along_y = np.array([flux_along(F, -x, lines, circles, order, 0.5 * np.pi) for x in lines])  # [line, row]
    flux = np.empty((count, count))
    for row in range(count):
        for column in range(count):
            flux[row, column] = (along_x[row, column] - along_x[row + 1, column]
                                 + along_y[column + 1, row] - along_y[column, row])
    return flux / edge**2


def cell_means(n_cells=scene.CELLS, slab=Slab(), table=None, edge=scene.PLATE_EDGE):
    """The mean illuminance of n x n squares of the plate [lx], rows along y and columns along x, and an estimate of the
    largest error of any, relative to its value: from two orders of Gauss's rule."""
    F = PlaneFlux(slab, scene_table() if table is None else table)
    lines = edge * (np.arange(n_cells + 1) - 0.5 * n_cells) / n_cells
    coarse, fine = (grid_means(F, lines, order) for order in ORDERS)
    return fine, float(np.max(np.abs(coarse / fine - 1)))


def reflections_to_side(slab=Slab(), widest=0.5 * scene.SLAB_EDGE):
    """How often light is reflected within the slab, at least, before it meets a side face."""
    gamma = math.radians(scene.GAMMAS[-1])
    above = scene.SOURCE_HEIGHT - scene.SLAB_HIGH
    sine, cosine = slab.behind(gamma)
    return max(0, math.floor((widest - above * math.tan(gamma)) / (slab.thickness * sine / cosine)))


def side_share(slab=Slab()):
    """A bound of the share of the light that ever meets a side face."""
    return float(np.max(slab.reflectance(np.radians(np.linspace(0, scene.GAMMAS[-1], 1001))))) ** reflections_to_side(slab)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("n", nargs="?", type=int, default=scene.CELLS)
    means, error = cell_means(parser.parse_args().n)
    print(f"mean {means.mean():.9g} lx, least {means.min():.9g} lx, largest {means.max():.9g} lx")
    print(f"error of the quadrature at most {error:.1e} of each; light by the slab's sides at most {side_share():.1e}")


if __name__ == "__main__":
    main()
