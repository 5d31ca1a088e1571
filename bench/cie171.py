#!/usr/bin/env python3
"""Validates Fluxel against cases 5.3, 5.4 and 5.6 to 5.8 in the style of CIE 171:2006, as a Markdown table.

    source scripts/mpi-env.sh; bench/cie171.py [--fluxel PROGRAM] [--form-factor RULE] [case ...]

The exact values are computed here. A solution is constant on an element, so what it gives at a measuring point
is the mean illuminance over the small square that holds the point; the exact value is therefore the mean of
the closed form over that square (Gauss-Legendre, 8 x 8). No error of discretisation is left between the two but
that of shadows. The column "mean / point - 1" says how far that mean is from the value at the point itself.

    B = rho H on receivers, which do not see what reflects in their channel: H = B / rho  (5.3, 5.4, 5.6, 5.7)
    B = E + rho H, E = rho times the point source's direct light: <H> = (<B> - <E>) / rho               (5.8)

In 5.8 H is the reflected light alone, for the point source itself is no surface of the scene. Its mean is exact
for any division into elements: B = E + rho F B, summed over a closed room with the areas A, gives
(1 - rho) sum A B = sum A E = rho times the source's flux, because what leaves an element arrives somewhere.
"""

import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "python")]

import fluxel
import numpy as np
from scene_parts import cie171 as scenes


def gauss_legendre(count):
    """Nodes and weights on [-1, 1]: Newton's method from the Chebyshev points."""
    rule = []
    for k in range(count):
        x = math.cos(math.pi * (k + 0.75) / (count + 0.5))
        for _ in range(20):
            before, value = 1.0, x
            for n in range(2, count + 1):
                before, value = value, ((2 * n - 1) * x * value - (n - 1) * before) / n
            slope = count * (x * value - before) / (x * x - 1)
            x -= value / slope
        rule.append((x, 2 / ((1 - x * x) * slope * slope)))
    return rule


def mean_over_square(function, edge, rule=tuple(gauss_legendre(8))):
    """Mean of function(s, t) over |s|, |t| <= edge / 2."""
    return sum(p * q * function(0.5 * edge * s, 0.5 * edge * t) for s, p in rule for t, q in rule) / 4


def facing(a, b, c):
    """From an element to a parallel rectangle a x b, one corner at distance c on its normal; odd in a, b."""
    p, q = math.hypot(a, c), math.hypot(b, c)
    return (a / p * math.atan(b / p) + b / q * math.atan(a / q)) / (2 * math.pi)


def upright(a, b, c):
    """From an upright element at height c to a level rectangle that begins at its foot and goes a away from its
    plane and b along it; odd in b."""
    p = math.hypot(a, c)
    return (math.atan(b / c) - c / p * math.atan(b / p)) / (2 * math.pi)


def configuration_factor(point, normal, rectangle):
    """Illuminance over exitance at a point, from a level rectangle: the two forms above, over its corners
    (J. R. Howell, "A Catalog of Radiation Configuration Factors", B-3 and B-4)."""
    x, y, z = point
    to_x, to_y = [u - x for u in rectangle.x], [v - y for v in rectangle.y]
    distance = abs(z - rectangle.z)
    if normal[2] == 0:
        to_x = sorted(normal[0] * u for u in to_x)
        form = upright
    else:
        form = facing
    return sum((-1) ** (i + j) * form(to_x[i], to_y[j], distance) for i in (0, 1) for j in (0, 1))


def patch_means(elements):
    """Areas (patches,) [m2], and mean B (patches, 3) of each channel."""
    areas = np.bincount(elements.patch, elements.areas)
    return areas, np.stack([np.bincount(elements.patch, elements.areas * B) / areas for B in elements.radiosity.T], axis=1)


@dataclass
class Row:
    case: str
    quantity: str
    exact: float
    computed: float
    at_point: float | None = None

    @property
    def error(self):
        return self.computed / self.exact - 1

    def cells(self):
        bias = "" if self.at_point is None else f"{100 * (self.exact / self.at_point - 1):+.3f} %"
        values = f"{self.exact:.6g}", bias, f"{self.computed:.6g}", f"{100 * self.error:+.3f} %"
        return self.case, self.quantity, *values


def point_rows(case, solve):
    """Illuminance at the receivers of one case, in lx."""
    areas, means = patch_means(solve(case.name))
    rows = []
    for number, receiver in enumerate(case.receivers):
        def illuminance(s, t, receiver=receiver):
            point = receiver.at(s, t)
            factors = (configuration_factor(point, receiver.normal, part) for part in case.visible(point))
            return scenes.EXITANCE * sum(factors)

        if not math.isclose(areas[number], scenes.RECEIVER_EDGE**2, rel_tol=1e-5):
            raise ValueError(f"{case.name}: patch {number} is not a receiver")
        computed = means[number, receiver.channel] / scenes.RECEIVER_RHO
        exact = mean_over_square(illuminance, scenes.RECEIVER_EDGE)
        rows.append(Row(case.name, f"lx, {receiver.describe()}", exact, computed, illuminance(0.0, 0.0)))
    return rows


def conservation_rows(name, solve):
    """Flux that lands on the floor and the walls against the flux through the opening, in lm."""
    opening, panel = scenes.OPENING, scenes.PANEL
    if name == "5.4-pane":
        exact = scenes.EXITANCE * opening.area
    else:
        middle, up = [sum(ends) / 2 for ends in (opening.x, opening.y)], (0.0, 0.0, 1.0)
        factor = lambda s, t: configuration_factor((middle[0] + s, middle[1] + t, opening.z), up, panel)
        exact = scenes.EXITANCE * opening.area * mean_over_square(factor, math.sqrt(opening.area))
    landed = 0.0
    for letter, channels in scenes.CONSERVATION_FILES.items():
        areas, means = patch_means(solve(f"{name}-{letter}"))
        for surface, channel in channels.items():
            patch = scenes.CONSERVATION_SURFACES.index(surface)
            landed += areas[patch] * means[patch, channel] / scenes.RECEIVER_RHO
    return [Row(name, "lm, landed on floor and walls", exact, landed)]


def cube_rows(name, solve):
    """Mean illuminance over the room by reflected light, in lx; the mean of E is rho flux / surface."""
    elements = solve(name)
    surface = elements.areas.sum()
    mean_of = elements.areas @ elements.radiosity / surface
    rows = []
    for mean_B, rho in zip(mean_of, scenes.CUBE_RHO):
        mean_H = (mean_B - rho * scenes.FLUX / surface) / rho
        exact = scenes.FLUX * rho / (surface * (1 - rho))
        rows.append(Row(name, f"lx, reflected light, mean, rho {rho:g}", exact, mean_H))
    return rows


CASES = {case.name: lambda solve, case=case: point_rows(case, solve) for case in scenes.POINT_CASES}
CASES |= {
    "5.4-pane": lambda solve: conservation_rows("5.4-pane", solve),
    "5.4-opening": lambda solve: conservation_rows("5.4-opening", solve),
    "5.8-cube": lambda solve: cube_rows("5.8-cube", solve),
}
COLUMNS = ("case", "quantity", "exact (mean)", "mean / point - 1", "computed", "error")


def main():
    raw = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=raw)
    parser.add_argument("cases", nargs="*", metavar="case", help=f"{', '.join(sorted(CASES))} (default: all)")
    parser.add_argument("--fluxel", type=Path, default=ROOT / "build/release/app/fluxel")
    parser.add_argument("--form-factor", help="rule for a pair (default: the program's own)")
    arguments = parser.parse_args()
    unknown = set(arguments.cases) - set(CASES)
    if unknown:
        parser.error(f"no case {', '.join(sorted(unknown))}")

    def solve(scene):
        return fluxel.solve(ROOT / f"scenes/cie171/{scene}.toml", executable=arguments.fluxel, ranks=2, threads=1, method="matrix",
                            no_error_estimate=True, form_factor=arguments.form_factor).elements

    print(f"| {' | '.join(COLUMNS)} |\n| {' | '.join('---' for _ in COLUMNS)} |")
    for name in arguments.cases or sorted(CASES):
        for row in CASES[name](solve):
            print(f"| {' | '.join(row.cells())} |", flush=True)


if __name__ == "__main__":
    main()
