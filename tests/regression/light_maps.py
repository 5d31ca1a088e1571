"""A light map as an engine reads it: surfaces and their places in the texture from the GLB, light from the EXR, between texels by bilinear
interpolation."""

from dataclasses import dataclass

import numpy as np

from glb_files import GlbFile

import fluxel


@dataclass
class LightMap:
    """
    groups, materials: of each triangle
    corners: (triangles, 3, 3) [m], y up where the scene was turned
    places: (triangles, 3, 2) in the map, in texels from its upper left corner
    metres: (triangles, 3, 2) along the surface
    """

    picture: fluxel.Picture
    model: dict
    png: bytes
    groups: np.ndarray
    materials: np.ndarray
    corners: np.ndarray
    places: np.ndarray
    metres: np.ndarray

    def light(self, places, layer=""):
        """(n, 3) of a layer at (n, 2) places."""
        values = self.picture[layer]
        rows, columns = values.shape[:2]
        x, y = np.clip(places[:, 0] - 0.5, 0, columns - 1), np.clip(places[:, 1] - 0.5, 0, rows - 1)
        left, top = np.minimum(x.astype(int), columns - 2), np.minimum(y.astype(int), rows - 2)
        u, v = (x - left)[:, None], (y - top)[:, None]
        return ((1 - v) * ((1 - u) * values[top, left] + u * values[top, left + 1])
                + v * ((1 - u) * values[top + 1, left] + u * values[top + 1, left + 1]))

    def samples(self, count, seed=1):
        """Random points of all surfaces, by area: triangles, points (n, 3), places (n, 2)."""
        random = np.random.default_rng(seed)
        sides = self.corners[:, 1] - self.corners[:, 0], self.corners[:, 2] - self.corners[:, 0]
        areas = np.linalg.norm(np.cross(*sides), axis=1)
        triangles = random.choice(len(areas), count, p=areas / areas.sum())
        a, b = np.sqrt(random.random(count)), random.random(count)
        weights = np.stack([1 - a, a * (1 - b), a * b], axis=1)[:, :, None]
        return triangles, (weights * self.corners[triangles]).sum(axis=1), (weights * self.places[triangles]).sum(axis=1)


def read_light_map(folder):
    file, picture = GlbFile(folder / "lightmap.glb"), fluxel.read_picture(folder / "lightmap.exr")
    size = np.array(picture.shape[::-1])
    parts = {"groups": [], "materials": [], "corners": [], "places": [], "metres": []}
    origin = np.array(file.model["nodes"][0]["translation"])
    for node, primitives in file.nodes():
        for primitive in primitives:
            index, attributes = file.values(primitive["indices"]), primitive["attributes"]
            triangles = index.reshape(-1, 3)
            parts["groups"] += [node["name"]] * len(triangles)
            parts["materials"] += [file.model["materials"][primitive["material"]]["name"]] * len(triangles)
            parts["corners"].append(origin + file.values(attributes["POSITION"]).astype(float)[triangles])
            parts["places"].append(file.values(attributes["TEXCOORD_1"]).astype(float)[triangles] * size)
            parts["metres"].append(file.values(attributes["TEXCOORD_0"]).astype(float)[triangles])
    (image,) = file.model["images"]
    return LightMap(picture, file.model, file.bytes_of(image["bufferView"]), np.array(parts["groups"]), np.array(parts["materials"]),
                    *(np.concatenate(parts[name]) for name in ("corners", "places", "metres")))
