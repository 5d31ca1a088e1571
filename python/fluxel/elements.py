"""Files of elements: solution.ply, solution-triangles.ply, reference.ply."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np

from .cursor import Cursor
from .mesh import Mesh, padded

TYPES = {"float": "<f4", "double": "<f8", "uchar": "u1", "uint": "<u4", "int": "<i4"}
CORNERS = ["list", "uchar", "uint", "vertex_indices"]


@dataclass
class Elements(Mesh):
    """The elements of a solution or reference, in the order of the file.

    layers: name -> (elements, 3) float32, of red, green, blue: "radiosity" [W/m2] of the fronts, or [lm/m2] in photometric
        scenes, "radiosity_back" in scenes with two-sided patches, "error", "half_a", "half_b" and their backs in references
    patch: (elements,) uint32, the number of each element's patch, in the order of the scene's files
    colour: (elements, 3) uint8, as programs show it (sRGB); None where the file has none
    """

    layers: dict[str, np.ndarray]
    patch: np.ndarray
    colour: np.ndarray | None

    @property
    def radiosity(self) -> np.ndarray:
        """(elements, 3) float32 [W/m2] of the fronts."""
        return self.layers["radiosity"]

    @property
    def radiosity_back(self) -> np.ndarray | None:
        """(elements, 3) float32 [W/m2] of the backs; None where no patch has two sides."""
        return self.layers.get("radiosity_back")

    @property
    def error(self) -> np.ndarray | None:
        """(elements, 3) float32 [W/m2], standard errors of a reference; None in a solution."""
        return self.layers.get("error")


def read_elements(file: str | os.PathLike[str]) -> Elements:
    """Reads a binary PLY file that Fluxel has written. Raises FormatError where it is another or ends too early."""
    cursor = Cursor.of_file(file)
    counts, properties = _read_header(cursor)
    if properties.get("vertex") != [["double", axis] for axis in "xyz"] or properties.get("face", [None])[0] != CORNERS:
        raise cursor.fail("is no file of elements: double x, y, z of vertices and the list vertex_indices of faces were to follow")
    vertices = cursor.array("<f8", 3 * counts["vertex"], "its vertices").reshape(-1, 3)
    values = np.dtype([(name, TYPES[kind]) for kind, name in properties["face"][1:]])
    faces, records = _read_faces(cursor, counts["face"], values)
    if cursor.place != len(cursor.data):
        raise cursor.fail(f"{len(cursor.data) - cursor.place} bytes follow its last face")
    if faces.max(initial=-1) >= len(vertices):
        raise cursor.fail(f"a face has the vertex {faces.max()} of {len(vertices)}")
    names = values.names or ()
    if "patch" not in names:
        raise cursor.fail("is no file of elements: its faces have no patch")
    joined = lambda parts: np.stack([records[part] for part in parts], axis=1)
    layers = {name[:-2]: joined([name[:-1] + colour for colour in "rgb"]) for name in names if name.endswith("_r")
              and {name[:-1] + "g", name[:-1] + "b"} <= set(names)}
    colour = joined(("red", "green", "blue")) if {"red", "green", "blue"} <= set(names) else None
    return Elements(vertices, faces, layers, records["patch"].copy(), colour)


def _read_header(cursor: Cursor) -> tuple[dict[str, int], dict[str, list[list[str]]]]:
    """Of each element of the format its count, and the words of its properties."""
    if cursor.data[:4] != b"ply\n":
        raise cursor.fail("is no PLY file")
    lines = cursor.text(b"end_header\n", "its header").splitlines()
    if "format binary_little_endian 1.0" not in lines:
        raise cursor.fail("is a PLY file of another kind than binary_little_endian 1.0")
    counts: dict[str, int] = {}
    properties: dict[str, list[list[str]]] = {}
    name = ""
    try:
        for words in map(str.split, lines):
            if words[:1] == ["element"]:
                name = words[1]
                counts[name], properties[name] = int(words[2]), []
            elif words[:1] == ["property"]:
                if words[1] != "list" and words[1] not in TYPES:
                    raise cursor.fail(f"the property {words[-1]} has the type {words[1]}, which Fluxel does not write")
                properties[name].append(words[1:])
    except (IndexError, KeyError, ValueError):
        raise cursor.fail("a line of its header is damaged") from None
    if list(counts) != ["vertex", "face"] or any(len(words) != 2 for words in properties["face"][1:]):
        raise cursor.fail("is no file of elements: its elements are to be vertex and face, with one list")
    return counts, properties


def _read_faces(cursor: Cursor, count: int, values: np.dtype) -> tuple[np.ndarray, np.ndarray]:
    """Numbers of vertices of each face, and what follows them, as an array of records."""
    data, place, end = cursor.data, cursor.place, len(cursor.data)
    starts = np.empty(count, np.int64)
    for number in range(count):
        starts[number] = place
        place += 1 + 4 * data[place] + values.itemsize if place < end else 1
        if place > end:
            raise cursor.fail(f"the file ends within face {number} of {count}")
    cursor.place = place
    raw = np.frombuffer(data, np.uint8)
    corners = raw[starts].astype(int)
    if corners.min(initial=3) < 3:
        raise cursor.fail(f"face {corners.argmin()} has {corners.min()} corners")
    most = corners.max(initial=3)
    faces, records = np.empty((count, most), np.int64), np.empty(count, values)
    for of in np.unique(corners):
        those = np.flatnonzero(corners == of)
        record = np.dtype([("corners", "u1"), ("outline", "<u4", (of,)), ("values", values)])
        rows = raw[starts[those, None] + np.arange(record.itemsize)].reshape(-1).view(record)
        faces[those], records[those] = padded(rows["outline"].astype(np.int64), most), rows["values"]
    return faces, records
