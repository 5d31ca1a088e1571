"""Writes one set of polygons in every geometry format that Fluxel reads."""

import base64
import json
import math
import struct
from dataclasses import dataclass


@dataclass
class Material:
    rho: tuple
    radiance: tuple = (0, 0, 0)

    @property
    def emits(self):
        return any(self.radiance)


@dataclass
class Shape:
    """Polygons (corner lists [m]) by material, {name: Material}."""

    materials: dict
    polygons: dict

    def triangles(self, name):
        """The fans of a material's polygons."""
        return [(p[0], b, c) for p in self.polygons[name] for b, c in zip(p[1:], p[2:])]


def write_obj(folder, shape, triangles=False):
    lines, count = ["mtllib shape.mtl"], 0
    for name in shape.materials:
        lines += [f"g {name}", f"usemtl {name}"]
        for polygon in shape.triangles(name) if triangles else shape.polygons[name]:
            lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in polygon]
            lines.append("f " + " ".join(str(count + k + 1) for k in range(len(polygon))))
            count += len(polygon)
    (folder / "shape.obj").write_text("\n".join(lines) + "\n")
    (folder / "shape.mtl").write_text("".join(
        "newmtl {}\nKd {} {} {}\nKe {} {} {}\n".format(name, *m.rho, *m.radiance) for name, m in shape.materials.items()))
    return folder / "shape.obj"


def write_gltf(folder, shape, binary):
    """Triangles with an index each, a mesh and a node a material; the buffer in the GLB, beside the file, or in it."""
    data, views, accessors, meshes, materials = b"", [], [], [], []

    def add(values, code, kind, component, **more):
        nonlocal data
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": struct.calcsize(code) * len(values)})
        accessors.append({"bufferView": len(views) - 1, "componentType": component, "type": kind,
                          "count": len(values) // (3 if kind == "VEC3" else 1), **more})
        data += struct.pack(f"<{len(values)}{code}", *values)
        return len(accessors) - 1

    for name, material in shape.materials.items():
        corners = [corner for triangle in shape.triangles(name) for corner in triangle]
        places = list(dict.fromkeys(corners))
        positions = add([x for place in places for x in place], "f", "VEC3", 5126,
                        min=[min(p[k] for p in places) for k in range(3)], max=[max(p[k] for p in places) for k in range(3)])
        indices = add([places.index(corner) for corner in corners], "I", "SCALAR", 5125)
        strength = max(material.radiance)
        emission = {"emissiveFactor": [x / strength for x in material.radiance],
                    "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}} if material.emits else {}
        materials.append({"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*material.rho, 1]}, **emission})
        meshes.append({"name": name, "primitives": [{"attributes": {"POSITION": positions}, "indices": indices,
                                                     "material": len(materials) - 1}]})
    data += b"\0" * (-len(data) % 4)
    buffer = {"byteLength": len(data)}
    if binary == "beside":
        (folder / "shape.bin").write_bytes(data)
        buffer["uri"] = "shape.bin"
    elif binary == "within":
        buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    text = json.dumps({
        "asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_emissive_strength"], "scene": 0,
        "scenes": [{"nodes": list(range(len(meshes)))}], "nodes": [{"mesh": k} for k in range(len(meshes))],
        "meshes": meshes, "materials": materials, "accessors": accessors, "bufferViews": views, "buffers": [buffer]})
    if binary != "glb":
        (folder / "shape.gltf").write_text(text)
        return folder / "shape.gltf"
    text = text.encode()
    text += b" " * (-len(text) % 4)
    (folder / "shape.glb").write_bytes(b"glTF" + struct.pack("<II", 2, 12 + 8 + len(text) + 8 + len(data)) +
                                       struct.pack("<I", len(text)) + b"JSON" + text +
                                       struct.pack("<I", len(data)) + b"BIN\0" + data)
    return folder / "shape.glb"


def write_stl(folder, shape):
    """A binary file a material, in a scene file that says what they are."""
    tables = []
    for name in shape.materials:
        triangles = shape.triangles(name)
        data = name.encode().ljust(80, b" ") + struct.pack("<I", len(triangles))
        for triangle in triangles:
            data += struct.pack("<12fH", 0, 0, 0, *(x for corner in triangle for x in corner), 0)
        (folder / f"{name}.stl").write_bytes(data)
        tables.append(f'[[geometry]]\nfile = "{name}.stl"\nmaterial = "{name}"\nmetres_per_unit = 1\n')
    for name, material in shape.materials.items():
        tables.append(f"[materials.{name}]\nrho = {list(material.rho)}\nE = {[math.pi * x for x in material.radiance]}\n")
    (folder / "stl.toml").write_text("".join(tables))
    return folder / "stl.toml"


def write_ply(folder, shape):
    """An ASCII file with the reflectances as colours of faces, in a scene file that adds what emits."""
    vertices, faces, tables = [], [], ['[[geometry]]\nfile = "shape.ply"\nmetres_per_unit = 1\n']
    for name, material in shape.materials.items():
        for polygon in shape.polygons[name]:
            corners = " ".join(str(len(vertices) + k) for k in range(len(polygon)))
            faces.append(f"{len(polygon)} {corners} " + " ".join(map(repr, material.rho)))
            vertices += [" ".join(map(repr, corner)) for corner in polygon]
        if material.emits:
            steps = [round(255 * (12.92 * x if x <= 0.0031308 else 1.055 * x ** (1 / 2.4) - 0.055)) for x in material.rho]
            tables.append(f'[materials."colour {steps[0]} {steps[1]} {steps[2]}"]\nE = {[math.pi * x for x in material.radiance]}\n')
    coordinates, colours = ("".join(f"property double {name}\n" for name in names) for names in ("xyz", ("red", "green", "blue")))
    (folder / "shape.ply").write_text(
        f"ply\nformat ascii 1.0\nelement vertex {len(vertices)}\n{coordinates}element face {len(faces)}\n"
        f"property list uchar int vertex_indices\n{colours}end_header\n" + "\n".join(vertices + faces) + "\n")
    (folder / "ply.toml").write_text("".join(tables))
    return folder / "ply.toml"


def write_radiance(folder, shape):
    """In a scene file whose surfaces have the one side that they have in other formats."""
    lines = []
    for name, material in shape.materials.items():
        if material.emits:
            lines.append("void light {}\n0\n0\n3 {} {} {}\n".format(name, *material.radiance))
        else:
            lines.append("void plastic {}\n0\n0\n5 {} {} {} 0 0\n".format(name, *material.rho))
        for k, polygon in enumerate(shape.polygons[name]):
            lines.append(f"{name} polygon {name}.{k}\n0\n0\n{3 * len(polygon)}\n" +
                         "".join("  {!r} {!r} {!r}\n".format(*corner) for corner in polygon))
    (folder / "shape.rad").write_text("\n".join(lines))
    (folder / "rad.toml").write_text('[[geometry]]\nfile = "shape.rad"\nmetres_per_unit = 1\n' + "".join(
        f'[materials.{name}]\nsides = "one"\n' for name in shape.materials))
    return folder / "rad.toml"
