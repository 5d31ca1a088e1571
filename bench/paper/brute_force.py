"""The visibility matrix without any structure over the scene: every element is tested against the segment of every pair."""

import numpy as np

LIFT = 1e-6  # of a segment's length, at both ends, so that its own elements do not block it


def blocked_pairs(elements):
    """Their number; elements are parallelograms."""
    corners = elements.corners[:, [0, 1, 3]]
    origin, edges = corners[:, 0], corners[:, 1:] - corners[:, :1]
    normals = np.cross(edges[:, 0], edges[:, 1])
    # Of a point in the plane: its place along both edges.
    along = np.stack([np.cross(edges[:, 1], normals), np.cross(normals, edges[:, 0])], axis=1)
    places = along / (normals**2).sum(axis=1)[:, None, None]
    offsets = np.einsum("ij,ij->i", origin, normals)
    starts = np.einsum("nkj,nj->nk", places, origin)
    centres = elements.centres
    blocked = 0
    for number, centre in enumerate(centres[:-1]):
        towards = centres[number + 1:] - centre
        with np.errstate(divide="ignore", invalid="ignore"):
            at = (offsets - normals @ centre) / (towards @ normals.T)
            hit = (at > LIFT) & (at < 1 - LIFT)
            for edge in (0, 1):
                place = places[:, edge] @ centre - starts[:, edge] + at * (towards @ places[:, edge].T)
                hit &= (place >= 0) & (place <= 1)
        blocked += int(hit.any(axis=1).sum())
    return blocked
