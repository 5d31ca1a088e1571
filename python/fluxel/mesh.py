"""Polygons with shared vertices, as files of elements hold them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass
class Mesh:
    """
    vertices: (vertices, 3) float64, world coordinates [m]
    faces: (faces, corners) int64, numbers of vertices, counterclockwise seen from the front; -1 where a face has fewer
        corners than others, always at the end of its row
    """

    vertices: np.ndarray
    faces: np.ndarray

    def __len__(self) -> int:
        """The number of faces."""
        return len(self.faces)

    @property
    def corners(self) -> np.ndarray:
        """(faces, corners, 3) float64 [m]; not a number where a face has fewer corners than others."""
        return np.where(self.faces[..., None] < 0, np.nan, self.vertices[self.faces])

    @property
    def _vector_areas(self) -> np.ndarray:
        """(faces, 3) [m2]: normal times area (half the sum of the cross products of a fan from the first corner)."""
        first = self.vertices[self.faces[:, 0]]
        total = np.zeros((len(self.faces), 3))
        for b, c in zip(self.faces.T[1:], self.faces.T[2:]):
            there = c >= 0
            total[there] += np.cross(self.vertices[b[there]] - first[there], self.vertices[c[there]] - first[there])
        return total / 2

    @property
    def areas(self) -> np.ndarray:
        """(faces,) float64 [m2]"""
        return np.linalg.norm(self._vector_areas, axis=1)

    @property
    def normals(self) -> np.ndarray:
        """(faces, 3) float64, unit vectors out of the fronts."""
        vectors = self._vector_areas
        return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)

    @property
    def centres(self) -> np.ndarray:
        """(faces, 3) float64 [m], means of the corners: of triangles and parallelograms the centroids."""
        return np.nanmean(self.corners, axis=1)

    def triangles(self) -> tuple[np.ndarray, np.ndarray]:
        """Faces cut into triangles, for programs that show no others: (triangles, 3) numbers of vertices, and (triangles,)
        numbers of the faces that they are of."""
        fans = [np.stack([self.faces[:, 0], b, c], axis=1) for b, c in zip(self.faces.T[1:], self.faces.T[2:])]
        numbers = np.tile(np.arange(len(self.faces)), len(fans))
        corners = np.concatenate(fans)
        there = corners[:, 2] >= 0
        order = np.argsort(numbers[there], kind="stable")
        return corners[there][order], numbers[there][order]


def padded(rows: np.ndarray, corners: int) -> np.ndarray:
    """Faces with -1 appended to so many corners."""
    return np.pad(rows, ((0, 0), (0, corners - rows.shape[1])), constant_values=-1)
