"""Polygons in named groups, their orientation checks, and the OBJ, MTL and TOML files made of them."""

import math
from dataclasses import dataclass, field


def subtract(p, q):
    return tuple(a - b for a, b in zip(p, q))


def add(p, q):
    return tuple(a + b for a, b in zip(p, q))


def dot(p, q):
    return sum(a * b for a, b in zip(p, q))


def cross(p, q):
    return (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])


def area_vector(face):
    """Normal by the right-hand rule, as long as the area (Newell 1972, exact for planar polygons)."""
    total = (0.0, 0.0, 0.0)
    for i in range(1, len(face) - 1):
        total = add(total, cross(subtract(face[i], face[0]), subtract(face[i + 1], face[0])))
    return tuple(0.5 * a for a in total)


def centroid(face):
    return tuple(sum(corner[k] for corner in face) / len(face) for k in range(3))


def number(value):
    """The shortest decimal form; OBJ, MTL and TOML all read it."""
    text = f"{value:.9g}"
    return "0" if text == "-0" else text


@dataclass
class Material:
    rho: tuple
    Ke: tuple = (0.0, 0.0, 0.0)
    heat: dict = field(default_factory=dict)  # emissivity, temperature [K], heat_flux [W/m2]


@dataclass
class Mesh:
    """Faces are lists of corners, counter-clockwise seen from the side that sends and receives."""

    materials: dict = field(default_factory=dict)
    faces: list = field(default_factory=list)  # (group, material, corners)

    def add(self, group, material, faces, *, towards=None, away_from=None):
        """Appends faces and refuses those that do not look towards, or away from, the given point."""
        if material not in self.materials:
            raise ValueError(f"{group}: no material {material}")
        for face in faces:
            normal, middle = area_vector(face), centroid(face)
            if towards is not None and dot(normal, subtract(towards, middle)) <= 0:
                raise ValueError(f"{group}: a face at {middle} looks away from {towards}")
            if away_from is not None and dot(normal, subtract(middle, away_from)) <= 0:
                raise ValueError(f"{group}: a face at {middle} looks towards {away_from}")
            self.faces.append((group, material, [tuple(map(float, corner)) for corner in face]))

    def require_closed(self, groups, *, outward):
        """Each edge of the groups' faces is used once in each direction; the enclosed volume has the right sign."""
        directed, volume = {}, 0.0
        for group, _, face in self.faces:
            if group not in groups:
                continue
            volume += dot(centroid(face), area_vector(face)) / 3
            for start, end in zip(face, face[1:] + face[:1]):
                directed[start, end] = directed.get((start, end), 0) + 1
        for (start, end), times in directed.items():
            if times != 1 or directed.get((end, start)) != 1:
                raise ValueError(f"{groups}: not closed at {start}-{end}")
        if (volume > 0) != outward:
            raise ValueError(f"{groups}: turned inside out")

    def triangles(self):
        return sum(len(face) - 2 for _, _, face in self.faces)

    def triangulate(self):
        self.faces = [
            (group, material, [face[0], face[i], face[i + 1]])
            for group, material, face in self.faces
            for i in range(1, len(face) - 1)
        ]

    def obj(self, heading, mtl_name):
        lines = [f"# {line}" for line in heading] + [f"mtllib {mtl_name}"]
        numbers, vertices, body = {}, [], []
        last_group = last_material = None
        for group, material, face in self.faces:
            if group != last_group:
                body.append(f"g {group}")
            if material != last_material:
                body.append(f"usemtl {material}")
            last_group, last_material = group, material
            for corner in face:
                if corner not in numbers:
                    numbers[corner] = len(numbers) + 1
                    vertices.append("v " + " ".join(map(number, corner)))
            body.append("f " + " ".join(str(numbers[corner]) for corner in face))
        return "\n".join(lines + vertices + body) + "\n"

    def mtl(self, heading):
        lines = [f"# {line}" for line in heading]
        for name, material in self.materials.items():
            lines.append(f"newmtl {name}")
            lines.append("Kd " + " ".join(map(number, material.rho)))
            if any(material.Ke):
                lines.append("Ke " + " ".join(map(number, material.Ke)))
            lines += [f"{name} {number(value)}" for name, value in material.heat.items()]
        return "\n".join(lines) + "\n"


def grey(value):
    return (value, value, value)


def quad(origin, first, second):
    """A parallelogram with the normal first x second."""
    return [origin, add(origin, first), add(add(origin, first), second), add(origin, second)]


def box_faces(low, high):
    """The six faces of an axis-parallel box by name, normals outward."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    return {
        "bottom": [(x0, y0, z0), (x0, y1, z0), (x1, y1, z0), (x1, y0, z0)],
        "top": [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
        "front": [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)],
        "back": [(x1, y1, z0), (x0, y1, z0), (x0, y1, z1), (x1, y1, z1)],
        "left": [(x0, y1, z0), (x0, y0, z0), (x0, y0, z1), (x0, y1, z1)],
        "right": [(x1, y0, z0), (x1, y1, z0), (x1, y1, z1), (x1, y0, z1)],
    }


def room_faces(low, high):
    """The same faces turned inward."""
    return {name: face[:1] + face[:0:-1] for name, face in box_faces(low, high).items()}


def split_around(face, first_cuts, second_cuts):
    """A rectangle as a 3 x 3 grid, cut at two fractions of each direction: (frame of 8 rectangles, middle)."""
    origin = face[0]
    first, second = subtract(face[1], origin), subtract(face[3], origin)
    at = lambda s, t: tuple(o + s * a + t * b for o, a, b in zip(origin, first, second))
    s_values, t_values = (0.0, *first_cuts, 1.0), (0.0, *second_cuts, 1.0)
    cells = {}
    for i in range(3):
        for j in range(3):
            (s0, s1), (t0, t1) = s_values[i : i + 2], t_values[j : j + 2]
            cells[i, j] = [at(s0, t0), at(s1, t0), at(s1, t1), at(s0, t1)]
    middle = cells.pop((1, 1))
    return list(cells.values()), middle


def point_factor(point, normal, polygon):
    """Form factor of a surface element to an unoccluded polygon in front of it (Lambert 1760; Baum et al. 1989)."""
    total, to_corner = 0.0, [subtract(corner, point) for corner in polygon]
    for a, b in zip(to_corner, to_corner[1:] + to_corner[:1]):
        normal_ab = cross(a, b)
        length = math.sqrt(dot(normal_ab, normal_ab))
        total += math.atan2(length, dot(a, b)) * dot(normal, normal_ab) / length
    return abs(total) / (2 * math.pi)


@dataclass
class SceneFile:
    """The text of one TOML scene file."""

    title: str
    about: str
    geometry: str
    camera: dict
    options: dict
    metres_per_unit: float = 1.0
    materials: dict = field(default_factory=dict)  # name -> {"rho": ..., "E": ...}
    units: str = ""  # "photometric"; as the files say, if empty
    tables: str = ""  # [[luminaires]], [[receivers]], as they stand

    def text(self):
        about = self.about.strip()
        if '"""' in about or "\\" in about:
            raise ValueError("about cannot be written as it is")
        lines = [f'title = "{self.title}"', f'about = """\n{about}\n"""', ""]
        if self.units:
            lines += [f'units = "{self.units}"', ""]
        lines += ["[[geometry]]", f'file = "{self.geometry}"']
        if self.metres_per_unit != 1.0:
            lines.append(f"metres_per_unit = {toml_value(self.metres_per_unit)}")
        for name, overrides in self.materials.items():
            lines += ["", f"[materials.{name}]"] + toml_lines(overrides)
        if self.tables:
            lines += self.tables.rstrip().splitlines()
        if self.camera:
            lines += ["", "[camera]"] + toml_lines(self.camera)
        # What the MTL files of these scenes say, unless they say another.
        light = {} if self.options.get("thermal") else {"ke": "exitance"}
        lines += ["", "[options]"] + toml_lines({**light, **self.options})
        return "\n".join(lines) + "\n"


def toml_value(value):
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, (tuple, list)):
        return "[" + ", ".join(map(toml_value, value)) + "]"
    if isinstance(value, int):
        return str(value).lower()  # True is an int too
    text = number(value)
    return text if any(c in text for c in ".e") else text + ".0"


def toml_lines(table):
    return [f"{key} = {toml_value(value)}" for key, value in table.items()]
