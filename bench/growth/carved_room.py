"""A room with carved and turned things, tessellated as finely as one likes: the same surfaces from ever more and smaller
triangles.

Lengths are metres, z is up, the corner of the room is the origin. A surface is a function of (u, v) in the unit square,
whose grid of cells has two triangles a cell. Curved surfaces (a wavy relief in place of the back wall, turned posts, a torus,
spheres) are connected meshes, whose vertices lie on the true surface at every fineness; walls, boxes and the lamp are soup:
every triangle has vertices of its own.
"""

from dataclasses import dataclass
from math import cos, pi, sin

SIZE = (6.0, 5.0, 3.0)
MATERIALS = {  # reflectance, exitance [W/m2]
    "plaster": ((0.7, 0.7, 0.7), (0, 0, 0)), "red": ((0.6, 0.2, 0.15), (0, 0, 0)), "green": ((0.2, 0.5, 0.25), (0, 0, 0)),
    "boards": ((0.45, 0.3, 0.2), (0, 0, 0)), "stone": ((0.6, 0.6, 0.65), (0, 0, 0)), "wood": ((0.5, 0.35, 0.2), (0, 0, 0)),
    "lamp": ((0, 0, 0), (40, 36, 30))}
LAMP = (2.2, 1.8, 2.7, 1.6, 1.0)  # low corner, width, depth: it hangs and shines down
POSTS, POST_HEIGHT = 7, 0.9
DIGITS = 7  # of a coordinate behind the point: the finest edges are millimetres
CAMERA = ("--eye", "0.5,0.4,1.7", "--look-at", "3.6,3.6,0.6", "--up", "0,0,1", "--fov", "52")


@dataclass(frozen=True)
class Surface:
    group: str
    material: str
    columns: int  # cells along u at fineness 1
    rows: int  # along v
    place: object  # (u, v) -> (x, y, z); du x dv is the normal
    soup: bool = False

    def triangles(self, fineness):
        """Corners of each. What a pole or a seam makes the same place is the same to the last digit."""
        columns, rows = fineness * self.columns, fineness * self.rows
        grid = [[tuple(round(x, DIGITS) + 0.0 for x in self.place(i / columns, j / rows)) for i in range(columns + 1)]
                for j in range(rows + 1)]
        for low, high in zip(grid, grid[1:]):
            for a, b, c, d in zip(low, low[1:], high[1:], high):
                yield from (corners for corners in ((a, b, c), (a, c, d)) if len(set(corners)) == 3)


def flat(group, material, origin, along_u, along_v, cell):
    """A parallelogram as soup of cells of about that size."""
    columns, rows = (max(1, round(sum(x * x for x in edge) ** 0.5 / cell)) for edge in (along_u, along_v))
    return Surface(group, material, columns, rows,
                   lambda u, v: tuple(o + u * a + v * b for o, a, b in zip(origin, along_u, along_v)), soup=True)


def box(group, material, low, high, cell, without=()):
    """Sides seen from outside; `without` leaves out some of "-x +x -y +y -z +z"."""
    for axis in range(3):
        u, v = ([high[k] - low[k] if k == other % 3 else 0 for k in range(3)] for other in (axis + 1, axis + 2))
        for name, origin, edges in (("+", [high[k] if k == axis else low[k] for k in range(3)], (u, v)),
                                    ("-", low, (v, u))):
            if name + "xyz"[axis] not in without:
                yield flat(group, material, origin, *edges, cell)


def turned(group, material, columns, rows, outline, x, y):
    """A surface of revolution about a vertical axis: outline(t) is (radius, z), from below."""

    def place(u, v):
        radius, z = outline(v)
        return x + radius * cos(2 * pi * u), y + radius * sin(2 * pi * u), z

    return Surface(group, material, columns, rows, place)


def post(t):
    """A baluster: a foot, a belly, a ring and a neck."""
    return (0.035 + 0.015 * sin(pi * t) + 0.02 * sin(3 * pi * t) ** 2 * (1 - 0.5 * t) + 0.006 * cos(12 * pi * t),
            POST_HEIGHT * t)


def sphere(radius, z):
    return lambda t: (radius * sin(pi * t), z - radius * cos(pi * t))


def torus(x, y, z, radius, thickness):
    def place(u, v):
        from_axis = radius + thickness * cos(2 * pi * v)
        return x + from_axis * cos(2 * pi * u), y + from_axis * sin(2 * pi * u), z + thickness * sin(2 * pi * v)

    return Surface("torus", "stone", 64, 24, place)


def relief(u, v):
    """Waves and petals of up to 16 cm out of the back wall, none at its edges."""
    width, depth, height = SIZE
    out = sin(pi * u) * sin(pi * v) * (0.08 + 0.04 * sin(14 * pi * u + 3 * sin(2 * pi * v)) +
                                       0.04 * sin(10 * pi * v) * cos(6 * pi * u))
    return width * u, depth - out, height * v


def surfaces():
    width, depth, height = SIZE
    yield flat("floor", "boards", (0, 0, 0), (width, 0, 0), (0, depth, 0), 0.25)
    yield flat("ceiling", "plaster", (0, 0, height), (0, depth, 0), (width, 0, 0), 0.25)
    yield flat("left-wall", "red", (0, 0, 0), (0, depth, 0), (0, 0, height), 0.25)
    yield flat("right-wall", "green", (width, 0, 0), (0, 0, height), (0, depth, 0), 0.25)
    yield flat("front-wall", "plaster", (0, 0, 0), (0, 0, height), (width, 0, 0), 0.25)
    yield Surface("relief", "plaster", 64, 32, relief)
    x, y, z, across, along = LAMP
    yield flat("lamp", "lamp", (x, y, z), (0, along, 0), (across, 0, 0), 0.2)
    for k in range(POSTS):
        yield turned("posts", "wood", 16, 32, post, 1.2 + 0.25 * k, 3.4)
    yield from box("rail", "wood", (1.05, 3.34, POST_HEIGHT), (2.85, 3.46, POST_HEIGHT + 0.06), 0.06)
    yield from box("pedestal", "stone", (4.1, 3.3, 0), (4.9, 4.1, 0.7), 0.1, without=("-z",))
    yield torus(4.5, 3.7, 0.82, 0.26, 0.12)
    yield turned("spheres", "stone", 32, 16, sphere(0.2, 1.1), 4.5, 3.7)
    yield turned("spheres", "plaster", 32, 16, sphere(0.3, 0.3), 3.5, 2.6)
    yield turned("spheres", "red", 32, 16, sphere(0.18, 0.18), 4.3, 2.4)


def write_carved_room(path, times):
    """Writes PATH and the MTL beside it, `times` as many triangles as at 1, a square number."""
    fineness = round(times ** 0.5)
    materials = path.with_suffix(".mtl")
    text = lambda values: " ".join(f"{value:g}" for value in values)
    materials.write_text("".join(f"newmtl {name}\nKd {text(rho)}\nKe {text(light)}\n"
                                 for name, (rho, light) in MATERIALS.items()), encoding="ascii")
    vertices = 0
    with open(path, "w", encoding="ascii") as file:
        file.write(f"mtllib {materials.name}\n")
        for surface in surfaces():
            file.write(f"g {surface.group}\nusemtl {surface.material}\n")
            known = {}
            for triangle in surface.triangles(fineness):
                numbers = []
                for corner in triangle:
                    number = None if surface.soup else known.get(corner)
                    if number is None:
                        vertices += 1
                        number = known[corner] = vertices
                        file.write("v {} {} {}\n".format(*corner))
                    numbers.append(number)
                file.write("f {} {} {}\n".format(*numbers))
