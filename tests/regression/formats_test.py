"""One scene is the same in every format; what Fluxel does not model is named whatever the format."""

import json
import math
import os
import re
import shutil
import struct
import subprocess
import unittest

import geometry_files
from fluxel_job import MATRIX, SCENES, JobTest, start
from geometry_files import Material, Shape
from result_files import read_elements

BLENDER = shutil.which("blender")


def cornell_box():
    """The polygons of the Cornell box [m], its lamp black as a light of Radiance is."""
    vertices, polygons, material = [], {}, None
    for words in map(str.split, (SCENES / "cornell-box" / "cornell-box.obj").read_text().splitlines()):
        if words[:1] == ["v"]:
            vertices.append(tuple(float(word) / 1000 for word in words[1:]))
        elif words[:1] == ["usemtl"]:
            material = words[1]
        elif words[:1] == ["f"]:
            polygons.setdefault(material, []).append([vertices[int(word) - 1] for word in words[1:]])
    return Shape({"white": Material((0.725, 0.71, 0.68)), "green": Material((0.14, 0.45, 0.091)),
                  "red": Material((0.63, 0.065, 0.05)), "light": Material((0, 0, 0), (17, 12, 4))}, polygons)


class ElementsTest(JobTest):
    """The radiosity of all elements, whatever their order."""

    method = (*MATRIX, "--subdivision", "uniform", "--max-edge", 0.1, "--tolerance", 3e-5, "--sides", "one")

    def elements(self, scene):
        job = self.solve(scene)
        self.assert_done(job)
        found = []
        for element in read_elements(self.out / "solution.ply"):
            corners = element["corners"]
            centre = tuple(round(sum(corner[k] for corner in corners) / len(corners), 5) + 0 for k in range(3))
            found.append((centre, element["radiosity"]))
        return sorted(found)

    def assert_same(self, found, expected, error):
        """Relative to the largest radiosity of what reflects."""
        self.assertEqual(len(found), len(expected))
        largest = max(B[0] for _, B in expected if B[0] < 10)
        self.assertGreater(largest, 0.1)
        for (place, B), (expected_place, expected_B) in zip(found, expected, strict=True):
            self.assertLess(math.dist(place, expected_place), 1e-4)
            for a, b in zip(B, expected_B, strict=True):
                self.assertLess(abs(a - b), error * largest, (place, B, expected_B))


class OneSceneTest(ElementsTest):
    def test_the_cornell_box(self):
        shape = cornell_box()
        expected = self.elements(geometry_files.write_obj(self.work, shape))
        self.assertGreater(len(expected), 400)
        for name, scene, error in (
                ("obj, triangles", geometry_files.write_obj(self.work, shape, triangles=True), 1e-6),
                ("ply", geometry_files.write_ply(self.work, shape), 1e-6),
                ("rad", geometry_files.write_radiance(self.work, shape), 1e-6),
                ("stl", geometry_files.write_stl(self.work, shape), 1e-5),
                ("glb", geometry_files.write_gltf(self.work, shape, "glb"), 1e-5),
                ("gltf and bin", geometry_files.write_gltf(self.work, shape, "beside"), 1e-5),
                ("gltf alone", geometry_files.write_gltf(self.work, shape, "within"), 1e-5)):
            with self.subTest(name):
                self.assert_same(self.elements(scene), expected, error)

    def test_a_change_would_be_seen(self):
        shape = cornell_box()
        expected = self.elements(geometry_files.write_obj(self.work, shape))
        shape.materials["red"] = Material((0.63, 0.066, 0.05))
        with self.assertRaises(AssertionError):
            self.assert_same(self.elements(geometry_files.write_ply(self.work, shape)), expected, 1e-5)


# Run by Blender, whose z axis is up: (x, y, z) of a shape stands at (x, -z, y).
IN_BLENDER = """
import bpy, json, math, sys
given, written = sys.argv[sys.argv.index("--") + 1:]
shape = json.load(open(given))
bpy.ops.wm.read_factory_settings(use_empty=True)
link = bpy.context.scene.collection.objects.link
for name, (rho, radiance, polygons) in shape.items():
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.use_backface_culling = True
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    strength = max(radiance)
    inputs["Base Color"].default_value = (*rho, 1)
    inputs["Emission"].default_value = (*(x / strength if strength else 0 for x in radiance), 1)
    inputs["Emission Strength"].default_value = strength
    mesh = bpy.data.meshes.new(name)
    corners = [(x, -z, y) for polygon in polygons for x, y, z in polygon]
    ends = [sum(map(len, polygons[:k + 1])) for k in range(len(polygons))]
    mesh.from_pydata(corners, [], [range(end - len(p), end) for end, p in zip(ends, polygons)])
    mesh.materials.append(material)
    link(bpy.data.objects.new(name, mesh))
camera = bpy.data.cameras.new("front")
camera.sensor_fit = "VERTICAL"
camera.angle_y = math.radians(39.3076)
front = bpy.data.objects.new("front", camera)
front.location = (0.278, 0.8, 0.273)
front.rotation_euler = (math.pi / 2, 0, math.pi)
link(front)
bpy.ops.export_scene.gltf(filepath=written, export_format="GLB", export_cameras=True)
"""


class BlenderTest(ElementsTest):
    @unittest.skipUnless(BLENDER, "there is no Blender")
    def test_what_blender_exports(self):
        shape = cornell_box()
        expected = self.elements(geometry_files.write_obj(self.work, shape))
        given = self.write("shape.json", json.dumps(
            {name: (m.rho, m.radiance, shape.polygons[name]) for name, m in shape.materials.items()}))
        exported = self.work / "exported.glb"
        subprocess.run([BLENDER, "--background", "--factory-startup", "--python-exit-code", "1", "--python",
                        self.write("in_blender.py", IN_BLENDER), "--", given, exported], check=True, capture_output=True,
                       timeout=120, env={**os.environ, "PATH": "/usr/bin:/bin"})  # whose Python is Blender's
        self.assert_same(self.elements(exported), expected, 1e-5)
        self.assert_done(self.solve(exported, "--dry-run", "--resolution", "8x8"))
        options = self.report()["options"]
        eye, target, up = (options[name] for name in ("eye", "look_at", "up"))
        along = [(b - a) / math.dist(eye, target) for a, b in zip(eye, target, strict=True)]
        for found, exact in ((eye, (0.278, 0.273, -0.8)), (along, (0, 0, 1)), (up, (0, 1, 0))):
            self.assertLess(math.dist(found, exact), 1e-6)
        self.assertAlmostEqual(options["fov"] / 39.3076, 1, delta=1e-6)


TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"


class UnmodelledTest(JobTest):
    """What a file has beyond Fluxel's model stands in the notes, with what it is taken for or where it stands."""

    def assert_named(self, scene, names):
        job = start(["info", scene], ranks=1)
        self.assert_done(job)
        notes = job.out.split("\nnotes:\n")[1].split("\n\n")[0]
        for name in names:
            with self.subTest(scene.name, name=name):
                self.assertRegex(notes, rf"(?<!\w){re.escape(name)}(?!\w)")

    def test_obj(self):
        self.write("a.mtl", "newmtl wall\nKd 0.5 0.5 0.5\nKe 1 1 1\nKs 0.9 0.9 0.9\nNs 200\nNi 1.5\nd 0.5\nTf 1 1 1\nillum 2\n"
                            "map_Bump bump.png\nmap_Ks gloss.png\nPr 0.1\n")
        scene = self.write("a.obj", "mtllib a.mtl\nusemtl wall\n" + TRIANGLE + "l 1 2\nf 1 2 3\n")
        self.assert_named(scene, ("Ks", "Ns", "Ni", "d", "Tf", "illum", "map_Bump", "map_Ks", "Pr", "l"))

    def test_gltf(self):
        shape = Shape({"wall": Material((0.5, 0.5, 0.5), (1, 1, 1))}, {"wall": [[(0, 0, 0), (1, 0, 0), (0, 1, 0)]]})
        scene = geometry_files.write_gltf(self.work, shape, "within")
        model = json.loads(scene.read_text())
        model["materials"][0].update(alphaMode="BLEND", normalTexture={"index": 0}, extensions={
            "KHR_materials_transmission": {}, "KHR_materials_ior": {}, "KHR_materials_clearcoat": {}})
        model["materials"][0]["pbrMetallicRoughness"]["metallicFactor"] = 1
        model["textures"] = [{}]
        model["animations"] = [{"channels": [], "samplers": []}]
        model["meshes"][0]["primitives"].append({"mode": 1, "attributes": {"POSITION": 0}})
        model["extensionsUsed"] += ["KHR_materials_transmission", "KHR_materials_ior", "KHR_materials_clearcoat", "EXT_unheard_of"]
        model["cameras"] = [{"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "zfar": 9, "znear": 1}}]
        model["nodes"][0]["camera"] = 0
        scene.write_text(json.dumps(model))
        self.assert_named(scene, ("KHR_materials_transmission", "KHR_materials_ior", "KHR_materials_clearcoat", "EXT_unheard_of",
                                  "metallic", "alphaMode", "normalTexture", "animations", "lines", "orthographic"))

    def test_radiance(self):
        scene = self.write("a.rad", "void plastic wall 0 0 5 .5 .5 .5 .1 .05\nvoid glass pane 0 0 3 .9 .9 .9\nvoid brightfunc dirt 2 a b 0 0\n"
                                    "dirt metal tin 0 0 5 .5 .5 .5 .9 0\nvoid mixfunc both 4 wall tin m f 0 0\nvoid light sun 0 0 3 9 9 9\n"
                                    "sun source sky 0 0 4 0 0 1 .5\nvoid instance tree 1 tree.oct 0 0\n!genbox wall box 1 1 1\n" +
                                    "".join(f"{name} polygon p.{name} 0 0 9 0 0 0 1 0 0 0 1 {k}\n" for k, name in
                                            enumerate(("wall", "pane", "tin", "both", "sun"))))
        self.assert_named(scene, ("glass", "brightfunc", "metal", "mixfunc", "source", "instance", "!genbox"))

    def test_meshes_and_photometry(self):
        (self.work / "a.stl").write_bytes(b" " * 80 + b"\x01\0\0\0" + struct.pack("<12fH", 0, 0, -1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 7))
        self.write("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n" + "".join(
            f"property float {name}\n" for name in ("x", "y", "z", "nx", "quality")) +
            "element face 1\nproperty list uchar int vertex_indices\nelement edge 0\nproperty int vertex1\nend_header\n"
            "0 0 0 0 1\n1 0 0 0 1\n0 1 0 0 1\n3 0 1 2\n")
        self.write("a.ies", "IESNA:LM-63-2002\nTILT=INCLUDE\n1 2 0 90 1 0.5\n1 1000 1 2 1 1 2 0.3 1.2 0.2 1 1 50\n0 90\n0\n100 100\n")
        scene = self.write("a.toml", "".join(f'[[geometry]]\nfile = "{name}"\n' for name in ("a.stl", "a.ply")) +
                           '[[luminaires]]\nname = "lamp"\nfile = "a.ies"\nposition = [0, 0, 1]\n')
        self.assert_named(scene, ("attributes", "stored normals", "nx", "quality", "edge", "TILT", "height"))


if __name__ == "__main__":
    unittest.main()
