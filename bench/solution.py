"""Reads the elements that Fluxel writes (solution.ply, reference.ply): areas, patches and radiosities."""

import math
import struct

PLY_TYPES = {"float": "f", "double": "d", "uchar": "B", "uint": "I", "int": "i"}


def read_faces(path):
    """A dictionary for each face of a binary PLY file: its properties by their names, and "corners" [m]."""
    with open(path, "rb") as file:
        data = file.read()
    place = data.index(b"end_header\n") + len(b"end_header\n")
    counts, properties = {}, {}
    for words in map(str.split, data[:place].decode("ascii").splitlines()):
        if words[0] == "element":
            element = words[1]
            counts[element], properties[element] = int(words[2]), []
        elif words[0] == "property":
            properties[element].append(words[1:])
    assert properties["vertex"] == [["double", axis] for axis in "xyz"], properties["vertex"]
    assert properties["face"][0] == ["list", "uchar", "uint", "vertex_indices"], properties["face"]
    corners = list(struct.iter_unpack("<3d", data[place:place + 24 * counts["vertex"]]))
    place += 24 * counts["vertex"]
    names = [name for _, name in properties["face"][1:]]
    values = struct.Struct("<" + "".join(PLY_TYPES[kind] for kind, _ in properties["face"][1:]))
    faces = []
    for _ in range(counts["face"]):
        outline = struct.unpack_from(f"<{data[place]}I", data, place + 1)
        place += 1 + 4 * len(outline)
        faces.append({"corners": [corners[k] for k in outline], **dict(zip(names, values.unpack_from(data, place)))})
        place += values.size
    assert place == len(data), "bytes are left over"
    return faces


def layer(face, name):
    """The three values of a layer, as of "radiosity_r", "radiosity_g", "radiosity_b"."""
    return tuple(face[f"{name}_{colour}"] for colour in "rgb")


def read_elements(path):
    """A list of (corners [m], patch, (r, g, b) of the front [W/m2]), an entry an element."""
    return [(face["corners"], face["patch"], layer(face, "radiosity")) for face in read_faces(path)]


def read_solution(path):
    """A list of (area [m2], patch, (r, g, b) of the front [W/m2]), an entry an element."""
    return [(area(corners), patch, radiosity) for corners, patch, radiosity in read_elements(path)]


def area(polygon):
    total = [0.0, 0.0, 0.0]
    for b, c in zip(polygon[1:], polygon[2:]):
        u = [b[k] - polygon[0][k] for k in range(3)]
        v = [c[k] - polygon[0][k] for k in range(3)]
        for k in range(3):
            total[k] += u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]
    return 0.5 * math.sqrt(sum(t * t for t in total))


def mean(elements):
    """Area-mean of the red channel."""
    return sum(a * B[0] for a, _, B in elements) / sum(a for a, _, _ in elements)


def deviation(elements, exact):
    """Area-weighted rms and largest |B - exact| of the red channel, relative to exact."""
    surface = sum(a for a, _, _ in elements)
    squares = sum(a * (B[0] / exact - 1) ** 2 for a, _, B in elements)
    return math.sqrt(squares / surface), max(abs(B[0] / exact - 1) for _, _, B in elements)
