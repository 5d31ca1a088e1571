"""The paper's loop (3.2) to the letter, for scenes of rectangles: raster, split what covers more than a pixel, again."""

import math
from dataclasses import dataclass

import numpy as np

SHRINK = math.sqrt(5 / 8)  # of a rectangle's radius by a bisection, at worst (of a square): s of eq. (7)


@dataclass
class Camera:
    """fov: vertical [radians]; size: pixels a side."""

    eye: np.ndarray
    look_at: np.ndarray
    up: np.ndarray
    fov: float
    size: int

    def directions(self):
        """(pixels, 3) through the middles of pixels, of depth 1."""
        forward = self._unit(self.look_at - self.eye)
        right = self._unit(np.cross(forward, self.up))
        up = np.cross(right, forward)
        steps = self.spacing * (np.arange(self.size) + 0.5) - math.tan(self.fov / 2)
        return (forward + steps[None, :, None] * right - steps[:, None, None] * up).reshape(-1, 3)

    @property
    def spacing(self):
        """Of neighbouring pixels, in the plane at depth 1."""
        return 2 * math.tan(self.fov / 2) / self.size

    def projected(self, points):
        """(..., 2) pixels."""
        forward = self._unit(self.look_at - self.eye)
        right = self._unit(np.cross(forward, self.up))
        seen = points - self.eye
        depth = seen @ forward
        across, down = seen @ right / depth, -(seen @ np.cross(right, forward)) / depth
        return np.stack([across, down], axis=-1) / self.spacing + self.size / 2 - 0.5

    @staticmethod
    def _unit(vector):
        return vector / np.linalg.norm(vector)


class Elements:
    """Of one rectangle, at every step: those of a step are the nodes of a binary tree that are no deeper."""

    def __init__(self, corners):
        self.origin = corners[0]
        self.edges = np.array([corners[1] - corners[0], corners[3] - corners[0]])
        self.low, self.high = np.zeros((1, 2)), np.ones((1, 2))  # in units of the edges
        self.halved = np.zeros(1, int)  # the edge that was halved last

    @property
    def corners(self):
        """(elements, 4, 3)."""
        places = np.stack([self.low, np.stack([self.high[:, 0], self.low[:, 1]], 1), self.high,
                           np.stack([self.low[:, 0], self.high[:, 1]], 1)], axis=1)
        return self.origin + places @ self.edges

    def split(self, number):
        """Across the middle of the longer sides."""
        low, high, halved = self.low[number], self.high[number], self.halved[number]
        lengths = (high - low) * np.linalg.norm(self.edges, axis=1)
        rows = np.arange(len(number))
        # The paper leaves open how squares are split. Here the side that was halved last is halved again, as by Fluxel.
        other_is_longer = lengths[rows, 1 - halved] > lengths[rows, halved] * (1 + 1e-9)
        axis = np.where(other_is_longer, 1 - halved, halved)
        middle = (low[rows, axis] + high[rows, axis]) / 2
        first_high, second_low = high.copy(), low.copy()
        first_high[rows, axis] = second_low[rows, axis] = middle
        kept = np.ones(len(self.low), bool)
        kept[number] = False
        self.low = np.concatenate([self.low[kept], low, second_low])
        self.high = np.concatenate([self.high[kept], first_high, high])
        self.halved = np.concatenate([self.halved[kept], axis, axis])


def nearest(camera, rectangles):
    """Of each ray the rectangle that it meets first (-1: none), its depth, and the place there in units of the edges."""
    directions = camera.directions()
    depth, found, place = np.full(len(directions), np.inf), np.full(len(directions), -1), np.zeros((len(directions), 2))
    for number, corners in enumerate(rectangles):
        edges = np.array([corners[1] - corners[0], corners[3] - corners[0]])
        normal = np.cross(*edges)
        with np.errstate(divide="ignore", invalid="ignore"):
            at = ((corners[0] - camera.eye) @ normal) / (directions @ normal)
        here = (camera.eye + at[:, None] * directions - corners[0]) @ np.linalg.pinv(edges)
        hit = (at > 0) & (at < depth) & (here >= 0).all(axis=1) & (here <= 1).all(axis=1)
        depth[hit], found[hit], place[hit] = at[hit], number, here[hit]
    return found, depth, place


def element_of(elements, places):
    """The number of the element that holds each place: a test of every element, as the paper's second list has it."""
    found = np.empty(len(places), int)
    for start in range(0, len(places), 512):
        part = places[start:start + 512, None]
        inside = ((part >= elements.low) & (part < elements.high)).all(axis=2)
        found[start:start + 512] = inside.argmax(axis=1)
    return found


def steps(camera, rectangles):
    """[list of Elements' corners of each rectangle] of each step, from the scene itself to the last."""
    elements = [Elements(corners) for corners in rectangles]
    while True:
        yield [of.corners for of in elements]
        # The paper makes the raster anew in each step. What a ray meets first is the same rectangle, as elements only divide it.
        found, _, places = nearest(camera, rectangles)
        changed = False
        for number, of in enumerate(elements):
            seen = np.bincount(element_of(of, places[found == number]), minlength=len(of.low))
            large = np.flatnonzero(seen > 1)
            if len(large):
                of.split(large)
                changed = True
        if not changed:
            return


def eq_7(camera, rectangles):
    """The paper's bound of the steps, its pixel being that of a picture from -1 to 1."""
    radius = max(np.linalg.norm(corners[2] - corners[0]) / 2 for corners in rectangles)
    return math.log(2 / camera.size / radius) / math.log(SHRINK)


def corrected_bound(camera, rectangles):
    """Until the diameter is below the least distance of what two pixels show on one rectangle (docs/method.md)."""
    found, depth, _ = nearest(camera, rectangles)
    corner = np.linalg.norm(camera.directions()[0])  # depth 1 along the axis
    bounds = []
    for number, corners in enumerate(rectangles):
        if (found == number).any():
            least = depth[found == number].min() * camera.spacing / corner
            bounds.append(math.log(least / np.linalg.norm(corners[2] - corners[0])) / math.log(SHRINK))
    return max(0, math.ceil(max(bounds)))
