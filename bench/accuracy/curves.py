"""Curves of error over time: reading them, the front of the best, and when an error is reached."""

import csv
import math
from dataclasses import dataclass
from pathlib import Path

# Curves of references, by their --sampling.
REFERENCES = {"even": "reference (paths)", "blocks": "reference by blocks"}
VIEW = "view of a solution"  # the time of its solve is not in it
FLAT = 0.05  # a curve whose error falls with less than this power of time goes nowhere


@dataclass(frozen=True)
class Point:
    seconds: float
    error: float
    low: float
    high: float
    elements: int = 0


def read(folder, kind):
    """{scene: {method: points}} with the time of `kind`, wall or cpu; points by time."""
    curves = {}
    with open(Path(folder) / "accuracy.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            low, error, high = (float(row[name]) for name in ("error_low", "error", "error_high"))
            # What noise hides is known to be below one standard error.
            point = Point(float(row[f"{kind}_s"]), error or high, low, high, int(row["elements"]))
            curves.setdefault(row["scene"], {}).setdefault(row["method"], []).append(point)
    with open(Path(folder) / "reference.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            error = float(row["error"])
            curves.setdefault(row["scene"], {}).setdefault(REFERENCES[row["sampling"]], []).append(
                Point(float(row[f"{kind}_s"]), error, error, error))
    for methods in curves.values():
        for points in methods.values():
            points.sort(key=lambda point: point.seconds)
    return curves


def pareto(methods):
    """The points that no other point beats in both time and error, by time."""
    front, best = [], math.inf
    for point in sorted((p for points in methods.values() for p in points), key=lambda p: (p.seconds, p.error)):
        if point.error < best:
            front.append(point)
            best = point.error
    return front


def slope(points):
    """The power of time by which the error falls between the first and the last point; None for fewer than two."""
    known = [p for p in points if p.error > 0]
    if len(known) < 2 or known[-1].seconds <= known[0].seconds:
        return None
    return math.log(known[-1].error / known[0].error) / math.log(known[-1].seconds / known[0].seconds)


def time_to(points, error):
    """(seconds, how): when a curve comes to an error; how is 'measured' (between two points, or before the first),
    'fitted' (by the power law of its last two points) or 'flat'."""
    known = [p for p in points if p.error > 0]
    for before, after in zip([None, *known], known):
        if after.error <= error:
            if before is None:
                return after.seconds, "measured"
            share = math.log(before.error / error) / math.log(before.error / after.error)
            return before.seconds * (after.seconds / before.seconds) ** share, "measured"
    power = slope(known[-2:])
    if power is None or power > -FLAT:
        return None, "flat"
    return known[-1].seconds * (error / known[-1].error) ** (1 / power), "fitted"
