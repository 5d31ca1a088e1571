"""--write lightmap: light in a texture over all surfaces, read as an engine does."""

import math
import signal
import subprocess
import time
import unittest

import numpy as np

from baked_mesh_test import CORNELL, TWO_ROOMS, BakedMeshTest
from fluxel_job import MATRIX, SCENES, JobTest, finish, launch, lines_until, start
from meshes_test import BLENDER, there_is
from rooms import MTL

import fluxel

FILES = ("lightmap.exr", "lightmap.glb", "lightmap.png")
READ_BY_BLENDER = """import numpy; numpy.bool = bool
import bpy, sys
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.import_scene.gltf(filepath=sys.argv[-1])
for o in bpy.context.scene.objects:
    if o.type == 'MESH':
        print('MESH', o.name, len(o.data.uv_layers), len(o.data.polygons), o.data.materials[0].name)
for image in bpy.data.images:
    print('IMAGE', image.size[0], image.size[1])
"""


def sides_of(corners):
    return corners[..., 1, :] - corners[..., 0, :], corners[..., 2, :] - corners[..., 0, :]


def samples(light_map, count):
    """Random points of all surfaces, by area: triangles, points (n, 3), places (n, 2)."""
    random = np.random.default_rng(1)
    areas = np.linalg.norm(np.cross(*sides_of(light_map.corners)), axis=1)
    triangles = random.choice(len(areas), count, p=areas / areas.sum())
    a, b = np.sqrt(random.random(count)), random.random(count)
    weights = np.stack([1 - a, a * (1 - b), a * b], axis=1)[:, :, None]
    return triangles, (weights * light_map.corners[triangles]).sum(axis=1), (weights * light_map.places[triangles]).sum(axis=1)


def weights_in(corners, points):
    """Barycentric, (n, 3), of points of a triangle's plane."""
    u, v = sides_of(corners)
    inverse = np.linalg.inv(np.array([[u @ u, u @ v], [u @ v, v @ v]]))
    of_sides = np.stack([(points - corners[0]) @ u, (points - corners[0]) @ v], axis=1) @ inverse
    return np.concatenate([1 - of_sides.sum(axis=1, keepdims=True), of_sides], axis=1)


def seams(light_map, layer):
    """The largest difference of light along the edges that triangles of one surface share, where both are lit, over the mean; and how
    many points of edges between charts were looked at."""
    normals = np.cross(*sides_of(light_map.corners))
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    steps = (np.arange(64)[:, None] + 0.5) / 64
    worst, count = 0, 0
    for one in range(len(normals)):
        for other in range(len(normals)):
            if (normals[one] @ normals[other] < 1 - 1e-9 or light_map.groups[one] != light_map.groups[other] or one == other
                    or abs((light_map.corners[other] - light_map.corners[one][0]) @ normals[one]).max() > 1e-6):
                continue
            for edge in range(3):
                ends = [edge, (edge + 1) % 3]
                on_edge, places = ((1 - steps) * ends_of[0] + steps * ends_of[1]
                                   for ends_of in (light_map.corners[one][ends], light_map.places[one][ends]))
                weights = weights_in(light_map.corners[other], on_edge)
                there = weights @ light_map.places[other]
                shared = (weights > -1e-6).all(axis=1) & (abs(places - there).max(axis=1) > 1)
                values = light_map.light(places[shared], layer), light_map.light(there[shared], layer)
                lit = (values[0].min(axis=1, initial=np.inf) > 0) & (values[1].min(axis=1, initial=np.inf) > 0)
                worst = max(worst, abs(values[0] - values[1])[lit].max(initial=0))
                count += lit.sum()
    return worst / light_map.picture[layer][light_map.picture[layer].sum(axis=2) > 0].mean(), count


class LightMapTest(JobTest):
    method = ()

    def light_map(self, scene, *options, **settings):
        self.assert_done(self.solve(scene, "--write", "lightmap", "--quiet", *options, **settings))
        return fluxel.read_light_map(self.out / "lightmap.glb")

    def assert_places(self, light_map):
        """Charts do not overlap, lie in the map, and are as large as the surfaces, in metres."""
        rows, columns = light_map.picture.shape
        self.assertGreaterEqual(light_map.places.min(), 2.5 - 1e-3, "padding, and half a texel")
        self.assertLessEqual((light_map.places - (columns, rows)).max(), -2.5 + 1e-3)
        for ends in ((0, 1), (1, 2), (2, 0)):
            lengths = [np.linalg.norm(corners[:, ends[0]] - corners[:, ends[1]], axis=1)
                       for corners in (light_map.corners, light_map.metres)]
            self.assertLess(abs(lengths[0] - lengths[1]).max(), 1e-5 * lengths[0].max())
        # Not mirrored: the normal comes out of the map where u goes to the right and v down.
        u, v = sides_of(light_map.places)
        self.assertTrue((u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] < 0).all())

    def test_cornell_box(self):
        mesh = BakedMeshTest()
        mesh.work, mesh.out = self.work, self.out
        true = mesh.reference()
        light_map = self.light_map(CORNELL, "--resolution", "16x16", "--target-error", 0.1, "--error-of", "surfaces",
                                   "--lightmap-texel", 0.01)
        self.assert_places(light_map)
        report = self.report()
        told = report["light_map"]
        self.assertEqual((told["height"], told["width"]), light_map.picture.shape)
        self.assertEqual(told["texel_m"], 0.01)
        self.assertEqual(light_map.png, (self.out / "lightmap.png").read_bytes())
        self.assertEqual(set(light_map.groups), {"floor", "ceiling", "back_wall", "left_wall", "right_wall", "light", "short_block",
                                                 "tall_block"})
        # What it sends, texel by texel, against paths of light; the steepest parts of a face's light are smoothed by its mean.
        triangles, _, places = samples(light_map, 20000)
        noise, error = (math.pi * light_map.light(places, layer) for layer in ("noise", "error"))
        mean = true.areas @ true.radiosity / true.areas.sum()
        middles = np.array([true.vertices[face[face >= 0]].mean(axis=0) for face in true.faces])
        normals = np.cross(*sides_of(light_map.corners))
        off, count = np.zeros(3), 0
        for middle, radiosity, area in zip(middles, true.radiosity, true.areas, strict=True):
            near = [k for k in range(len(normals)) if abs((middle - light_map.corners[k][0]) @ normals[k]) < 1e-6]
            for k in near:
                weights = weights_in(light_map.corners[k], middle[None])
                if (weights > 0).all():
                    off += area * (math.pi * light_map.light(weights @ light_map.places[k])[0] - radiosity) ** 2
                    count += 1
                    break
        self.assertGreater(count, 0.99 * len(middles))
        rms = (np.sqrt(off / true.areas.sum()) / mean).max()
        self.assertLess(rms, report["stated_error"])
        self.assertLess((np.sqrt((noise ** 2).mean(axis=0)) / mean).max(), 2 * told["noise"])
        common = np.sqrt((error ** 2 - noise ** 2).mean(axis=0)) / (report["stated_error"] * mean)
        self.assertLess(abs(common - 1).max(), 0.05)
        # No seams where the floor is cut around the blocks, which let no light below.
        worst, looked_at = seams(light_map, "irradiance")
        self.assertLess(worst, 1e-4)
        self.assertGreater(looked_at, 1000)
        # E + rho H of the materials.
        lamp = light_map.groups[triangles] == "light"
        self.assertLess((light_map.light(places[lamp]).std(axis=0) / light_map.light(places[lamp]).mean(axis=0)).max(), 0.02)

    def test_places_are_those_of_the_light(self):
        """Of a point above a black floor: a map that is shifted by half a texel, turned or mirrored is off by several percent."""
        lamp, height, texel = np.array([0.31, 0.42]), 0.5, 0.05
        self.write("floor.obj", "mtllib floor.mtl\nusemtl black\nv 0 0 0\nv 2 0 0\nv 2 1.3 0\nv 0 1.3 0\nf 1 2 3 4\n")
        self.write("floor.mtl", "newmtl black\nKd 0 0 0\n")
        scene = self.write("lamp.toml", f"""units = "photometric"
[[geometry]]
file = "floor.obj"
[options]
sides = "one"
[[luminaires]]
name = "point"
intensity = 100.0
position = [{lamp[0]}, {lamp[1]}, {height}]
""")
        light_map = self.light_map(scene, "--lightmap-texel", texel, "--target-error", 0.01)
        _, points, places = samples(light_map, 5000)
        inside = (points[:, :2].min(axis=1) > texel) & (points[:, 0] < 2 - texel) & (points[:, 1] < 1.3 - texel)
        squared = ((points[inside, :2] - lamp) ** 2).sum(axis=1) + height**2
        exact = 100 * height / squared**1.5
        found = light_map.light(places[inside], "irradiance")[:, 0]
        self.assertLess(abs(found / exact - 1).max(), 0.01)
        self.assertTrue((light_map.picture.values == 0).all(), "a black floor sends nothing")

    def test_a_signal_leaves_the_solution(self):
        for method in (("--target-error", 0.1), (*MATRIX, "--no-error-estimate")):
            with self.subTest(method=method):
                process = launch(["solve", CORNELL, "--resolution", "8x8", *method, "--write", "lightmap", "--lightmap-texel", 0.0008,
                                  "--out", self.out], ranks=2)
                self.assertTrue(lines_until(process.stderr, "gathering the light map")[-1].startswith("gathering the light map"))
                process.send_signal(signal.SIGUSR2)
                job = finish(process, time.monotonic())
                self.assertEqual(job.code, 75, job)
                self.assertTrue(any("light map, which is not written" in warning for warning in job.warnings), job)
                self.assertIn(b"a signal has ended the run", (self.out / "solution.ply").read_bytes()[:1000])
                self.assertIn("solution.ply", self.written())
                self.assertNotIn("lightmap.exr", self.written())

    def test_a_furnace_is_as_bright_everywhere(self):
        """Charts are many and small, and nothing is dark beside them."""
        light_map = self.light_map(SCENES / "furnace" / "furnace.toml", "--method", "hierarchical", "--target-error", 0.03, "--resolution", "8x8",
                                   "--lightmap-texel", 0.03)
        self.assert_places(light_map)
        self.assertEqual(self.report()["light_map"]["charts"], 1536)
        _, _, places = samples(light_map, 20000)
        B = math.pi * light_map.light(places)
        self.assertAlmostEqual(B.mean(), 1, delta=0.005)
        self.assertLess(abs(B - 1).max(), 0.06)  # in corners

    def test_a_dark_room_beside_a_bright_one(self):
        self.write("room.mtl", MTL)
        rooms = self.write("rooms.obj", TWO_ROOMS)
        for method in (("--target-error", 0.1), (*MATRIX, "--subdivision", "uniform", "--max-edge", 0.5)):
            with self.subTest(method=method):
                light_map = self.light_map(rooms, *method, "--lightmap-texel", 0.07)
                triangles, points, places = samples(light_map, 20000)
                light = light_map.light(places, "irradiance").max(axis=1)
                partition = light_map.groups[triangles] == "partition"
                dark = (points[:, 0] > 1) & ~partition
                self.assertEqual(light[dark].max(), 0)
                self.assertGreater(((points[:, 0] > 1) & (points[:, 0] < 1.07)).sum(), 100, "beside the partition")
                # Inside of the bright one; outside of both it is dark.
                lit = (points[:, 0] < 1) & ~partition
                self.assertAlmostEqual((light[lit] > 0).mean(), 0.5, delta=0.05)
                self.assertAlmostEqual((light[partition] > 0).mean(), 0.5, delta=0.05)

    def test_every_number_of_ranks_writes_the_same(self):
        for options in (("--exchange", "links"), ("--exchange", "rays")):
            files = []
            for ranks in (1, 3):
                self.light_map(CORNELL, "--resolution", "16x16", "--target-error", 0.1, "--lightmap-texel", 0.03, *options,
                               ranks=ranks)
                pixels = fluxel.read_light_map(self.out / "lightmap.glb").picture.channels
                files.append(([(self.out / name).read_bytes() for name in FILES[1:]],
                              {name: values.tobytes() for name, values in pixels.items()}))
            self.assertTrue(files[0] == files[1], options)  # a difference of them is too long to be told

    def test_a_view_without_a_camera(self):
        self.write("room.mtl", MTL)
        rooms, seen = self.write("rooms.obj", TWO_ROOMS), self.work / "seen"
        self.assert_done(self.solve(rooms, "--target-error", 0.1, "--quiet"))
        self.assert_done(start(["view", rooms, "--solution", self.out / "solution.ply", "--out", seen, "--write", "lightmap",
                                "--lightmap-texel", 0.1, "--target-error", 0.05], ranks=2))
        self.assertEqual({file.name for file in seen.iterdir()}, {"convergence.csv", "report.html", "report.json", *FILES})
        light_map = fluxel.read_light_map(seen / "lightmap.glb")
        _, _, places = samples(light_map, 20000)
        area = np.linalg.norm(np.cross(*sides_of(light_map.corners)), axis=1).sum() / 2
        power = area * math.pi * light_map.light(places).mean(axis=0)
        for found, exact in zip(power, self.report()["leaving"], strict=True):
            self.assertAlmostEqual(found / exact, 1, delta=0.05)

    def test_a_later_run_removes_what_it_does_not_write(self):
        scene = SCENES / "emitting-wall" / "emitting-wall.toml"
        self.light_map(scene, "--target-error", 0.1, "--lightmap-texel", 0.1)
        self.assertLessEqual(set(FILES), set(self.written()))
        self.assert_done(self.solve(scene, "--target-error", 0.1))
        self.assertFalse(set(FILES) & set(self.written()))

    def test_what_is_refused(self):
        job = start(["solve", CORNELL, "--write", "lightmap", "--lightmap-texel", 1e-5, "--out", self.out], ranks=2)
        self.assert_refused(job, "--lightmap-texel", "4096 x 4096", "ask for a larger one")
        for value in ("0", "-1", "nan"):
            job = start(["solve", CORNELL, "--write", "lightmap", f"--lightmap-texel={value}", "--out", self.out], ranks=1)
            self.assert_refused(job, "--lightmap-texel")
        job = self.solve(CORNELL, "--resolution", "8x8", "--target-error", 0.3, "--lightmap-texel", 0.1)
        self.assert_done(job)
        self.assertTrue(any("--lightmap-texel has no effect" in line for line in job.warnings), job)
        job = start(["solve", SCENES / "heating-chamber" / "heating-chamber.toml", "--dry-run", "--write", "lightmap", "--out", self.out],
                    ranks=1)
        self.assertTrue(any("--write has no effect" in line for line in job.warnings), job)

    @unittest.skipUnless(there_is("trimesh"), "there is no trimesh")
    def test_trimesh_reads_it(self):
        import trimesh
        light_map = self.light_map(CORNELL, "--resolution", "8x8", "--target-error", 0.1, "--lightmap-texel", 0.02)
        scene = trimesh.load(self.out / "lightmap.glb")
        self.assertEqual(sum(len(part.faces) for part in scene.geometry.values()), len(light_map.corners))
        materials = {part.visual.material.name for part in scene.geometry.values()}
        self.assertEqual(materials, set(light_map.materials))
        image = next(iter(scene.geometry.values())).visual.material.baseColorTexture
        self.assertEqual(image.size, light_map.picture.shape[::-1])

    @unittest.skipUnless(BLENDER, "there is no Blender")
    def test_blender_reads_it(self):
        light_map = self.light_map(CORNELL, "--resolution", "8x8", "--target-error", 0.1, "--lightmap-texel", 0.02)
        script = self.write("read.py", READ_BY_BLENDER)
        said = subprocess.run([BLENDER, "--background", "--factory-startup", "--python-exit-code", "1", "--python", script, "--",
                               self.out / "lightmap.glb"], check=True, capture_output=True, text=True, timeout=120,
                              env={"PATH": "/usr/bin:/bin", "HOME": str(self.work)}).stdout
        lines = [line.split() for line in said.splitlines()]
        meshes = {words[1]: words[2:] for words in lines if words[:1] == ["MESH"]}
        self.assertEqual(set(meshes), set(light_map.groups))
        for name, (layers, polygons, _) in meshes.items():
            self.assertEqual((int(layers), int(polygons)), (2, (light_map.groups == name).sum()))
        rows, columns = light_map.picture.shape
        self.assertIn(["IMAGE", str(columns), str(rows)], lines)


if __name__ == "__main__":
    unittest.main()
