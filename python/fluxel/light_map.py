"""Light maps: surfaces and their places in the texture from lightmap.glb, light from the lightmap.exr beside it."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .errors import FormatError
from .glb import GlbFile
from .picture import Picture, read_picture


@dataclass
class LightMap:
    """
    picture: lightmap.exr; layers "" (radiance, linear), "noise", "irradiance", "irradiance_noise" and, of runs that state an error
        of their surfaces, "error"
    corners: (triangles, 3, 3) [m], in the scene's coordinates
    places: (triangles, 3, 2) in the map, in texels from its upper left corner to the right and down
    metres: (triangles, 3, 2) along the surface, as TEXCOORD_0
    groups, materials: (triangles,) names
    model: what the GLB says of itself
    png: the bytes of the picture in the GLB
    """

    picture: Picture
    corners: np.ndarray
    places: np.ndarray
    metres: np.ndarray
    groups: np.ndarray
    materials: np.ndarray
    model: dict[str, Any]
    png: bytes

    def light(self, places: np.ndarray, layer: str = "") -> np.ndarray:
        """(n, 3): a layer at (n, 2) places, between the middles of texels by bilinear interpolation, as engines do."""
        values = self.picture[layer]
        rows, columns = values.shape[:2]
        x, y = np.clip(places[:, 0] - 0.5, 0, columns - 1), np.clip(places[:, 1] - 0.5, 0, rows - 1)
        left, top = np.minimum(x.astype(int), columns - 2), np.minimum(y.astype(int), rows - 2)
        u, v = (x - left)[:, None], (y - top)[:, None]
        return ((1 - v) * ((1 - u) * values[top, left] + u * values[top, left + 1])
                + v * ((1 - u) * values[top + 1, left] + u * values[top + 1, left + 1]))


def read_light_map(file: str | os.PathLike[str]) -> LightMap:
    """Reads lightmap.glb, and the picture of the same name with the ending .exr. Raises FormatError where one is damaged."""
    glb, picture = GlbFile(file), read_picture(Path(file).with_suffix(".exr"))
    if not glb.model.get("images"):
        raise FormatError(file, "is no light map: it has no picture")
    x, y, z = glb.model["nodes"][0]["translation"]
    origin = (x, -z, y) if "rotation" in glb.model["nodes"][0] else (x, y, z)  # of a scene whose z is up, which the file turns
    lists: dict[str, list[np.ndarray]] = {"POSITION": [], "TEXCOORD_0": [], "TEXCOORD_1": []}
    groups: list[str] = []
    materials: list[str] = []
    for node, primitives in glb.nodes():
        for primitive in primitives:
            triangles = glb.values(primitive["indices"]).reshape(-1, 3)
            for name, values in lists.items():
                values.append(glb.values(primitive["attributes"][name]).astype(float)[triangles])
            groups += [node["name"]] * len(triangles)
            materials += [glb.model["materials"][primitive["material"]]["name"]] * len(triangles)
    corners, metres, places = (np.concatenate(values) for values in lists.values())
    return LightMap(picture, corners + origin, places * picture.shape[::-1], metres, np.array(groups), np.array(materials), glb.model,
                    glb.bytes_of(glb.model["images"][0]["bufferView"]))
