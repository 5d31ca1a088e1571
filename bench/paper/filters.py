"""Low-pass filters of pictures. Fluxel's own Gaussian filter was taken out, because it made every picture worse."""

import numpy as np


def weighted(picture, places, sigma):
    """Along the rows: the mean around each place [pixels], by a Gaussian of that standard deviation; beyond the border nothing
    is averaged."""
    weights = np.exp(-0.5 * ((places[:, None] - np.arange(len(picture))) / sigma) ** 2)
    return np.tensordot(weights / weights.sum(axis=1, keepdims=True), picture.astype(float), axes=1)


def gaussian(picture, sigma):
    """(rows, columns, colours), blurred with that standard deviation [pixels]."""
    return gaussian_mean(picture, 1, sigma)


def gaussian_mean(picture, factor, sigma):
    """One pixel from factor x factor, by a Gaussian around its middle; sigma in the pixels that are made."""
    for _ in range(2):
        middles = factor * (np.arange(len(picture) // factor) + 0.5) - 0.5
        picture = weighted(picture, middles, factor * sigma).swapaxes(0, 1)
    return picture


def box(picture, factor):
    """Means of factor x factor pixels."""
    rows, columns, colours = picture.shape
    return picture.reshape(rows // factor, factor, columns // factor, factor, colours).astype(float).mean(axis=(1, 3))
