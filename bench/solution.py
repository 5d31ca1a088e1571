"""Reads solution.ply: areas, patches and radiosities of the elements."""

import math
import struct


def read_elements(path):
    """A list of (corners [m], patch, (r, g, b) of the front [W/m2]), an entry an element."""
    with open(path, "rb") as file:
        header = []
        while not header or header[-1] != "end_header":
            header.append(file.readline().decode("ascii").strip())
        data = file.read()
    vertices, faces = (int(line.split()[-1]) for line in header if line.startswith("element "))
    floats = sum(line.startswith("property float radiosity") for line in header)
    colour = sum(line.startswith("property uchar ") for line in header)
    corners = [struct.unpack_from("<3d", data, 24 * i) for i in range(vertices)]
    offset = 24 * vertices
    elements = []
    for _ in range(faces):
        count = data[offset]
        outline = struct.unpack_from(f"<{count}I", data, offset + 1)
        offset += 1 + 4 * count + colour
        *radiosity, patch = struct.unpack_from(f"<{floats}fI", data, offset)
        offset += 4 * floats + 4
        elements.append(([corners[c] for c in outline], patch, tuple(radiosity[:3])))
    return elements


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
