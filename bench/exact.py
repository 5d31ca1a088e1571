"""Errors of elements (fluxel.Elements) whose radiosity is known, of the red channel."""

import math


def red(elements):
    return elements.radiosity[:, 0].astype(float)


def mean(elements):
    """Area-mean of B."""
    return elements.areas @ red(elements) / elements.areas.sum()


def deviation(elements, exact):
    """Area-weighted rms and largest |B - exact|, relative to exact."""
    errors = red(elements) / exact - 1
    return math.sqrt(elements.areas @ errors**2 / elements.areas.sum()), abs(errors).max()
