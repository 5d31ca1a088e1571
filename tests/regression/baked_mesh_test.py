"""--mesh-max-edge: meshes that are written finer than the elements that were solved."""

import unittest

import numpy as np

from fluxel_job import MATRIX, SCENES, JobTest, start
from meshes_test import read_glb
from rooms import MTL

import fluxel

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
EDGE = 0.05

# Two rooms of 1 m beside each other under one ceiling and on one floor, of which the first one has a lamp.
TWO_ROOMS = """mtllib room.mtl
v 0 0 0
v 2 0 0
v 2 1 0
v 0 1 0
v 0 0 1
v 2 0 1
v 2 1 1
v 0 1 1
v 1 0 0
v 1 1 0
v 1 0 1
v 1 1 1
v 0.3 0.3 0.9
v 0.6 0.3 0.9
v 0.6 0.6 0.9
v 0.3 0.6 0.9
usemtl white
g floor
f 1 2 3 4
g ceiling
f 5 8 7 6
g walls
f 1 5 6 2
f 2 6 7 3
f 3 7 8 4
f 4 8 5 1
g partition
f 9 10 12 11
usemtl light
g lamp
f 13 16 15 14
"""


def light_of_triangles(parts):
    """The sum of A B over the triangles of a GLB, B linear over each."""
    sums = np.zeros(3)
    for _, positions, radiosities, _, faces in parts:
        corners, B = np.array(positions)[np.array(faces)], np.array(radiosities)[np.array(faces)]
        areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
        sums += areas @ B.mean(axis=1)
    return sums


class BakedMeshTest(JobTest):
    method = ()

    def baked(self, scene, *options, **settings):
        self.assert_done(self.solve(scene, "--write", "vtu,glb", "--quiet", *options, **settings))
        return fluxel.read_grid(self.out / "solution.vtu"), read_glb(self.out / "solution.glb"), self.report()

    def cornell(self, *options, **settings):
        return self.baked(CORNELL, "--resolution", "16x16", "--mesh-max-edge", EDGE, *options, **settings)

    def assert_light(self, grid, glb, report):
        """What the faces send, and what triangles between their corners do, is what the elements send."""
        _, parts = glb
        self.assertEqual(len(grid), report["mesh"]["faces"])
        self.assertEqual(sum(len(part[1]) for part in parts), report["mesh"]["vertices"])
        for sums in (grid.areas @ grid["radiosity"], light_of_triangles(parts)):
            for found, exact in zip(sums, report["leaving"], strict=True):
                self.assertAlmostEqual(found / exact, 1, delta=0.02)
        B, E, rho, H = (grid[name] for name in ("radiosity", "exitance", "reflectance", "irradiance"))
        self.assertLess(abs(B - E - rho * H).max(), 1e-5 * B.max())

    def reference(self):
        """The Cornell box's true light on faces of this size."""
        self.assert_done(self.solve(CORNELL, *MATRIX, "--subdivision", "uniform", "--max-edge", EDGE, "--resolution", "8x8",
                                    "--picture", "elements", "--no-error-estimate", "--audit", 0, "--form-factor", "point",
                                    "--quiet"))
        job = start(["reference", CORNELL, "--elements", self.out / "solution.ply", "--only", "elements", "--target-error", 0.02,
                     "--out", self.work / "reference", "--quiet"], ranks=2)
        self.assert_done(job)
        return fluxel.read_elements(self.work / "reference" / "reference.ply")

    def error(self, grid, true):
        """Root mean square over the mean, of the worst colour."""
        mean = true.areas @ true.radiosity / true.areas.sum()
        return (np.sqrt(true.areas @ (grid["radiosity"] - true.radiosity) ** 2 / true.areas.sum()) / mean).max()

    def test_few_leaves_make_a_fine_mesh(self):
        true = self.reference()
        grid, glb, report = self.cornell("--target-error", 0.1, "--error-of", "surfaces")
        self.assertEqual(len(grid), len(true))
        self.assertLess(10 * report["elements"], len(grid))
        self.assertTrue(np.allclose(grid.areas, true.areas, rtol=1e-5))
        self.assert_light(grid, glb, report)
        # 2.6 % when it was written, of which 2 are the reference's.
        self.assertLess(self.error(grid, true), 0.05)
        self.assertLess(0.05, report["stated_error"])
        # Two thirds of the faces are within their error, and their noise is what the report says.
        off = abs(grid["radiosity"] - true.radiosity)
        self.assertGreater((off < grid["error"]).mean(), 0.67)
        mean = true.areas @ grid["radiosity"] / true.areas.sum()
        noise = (np.sqrt(true.areas @ grid["noise"] ** 2 / true.areas.sum()) / mean).max()
        self.assertAlmostEqual(noise / report["mesh"]["noise"], 1, delta=0.5)
        self.assertEqual(len(fluxel.read_elements(self.out / "solution.ply")), report["elements"])

        # The matrix's elements are seen by rays.
        grid, glb, report = self.cornell(*MATRIX, "--subdivision", "uniform", "--max-edge", 0.2, "--no-error-estimate")
        self.assert_light(grid, glb, report)
        self.assertLess(self.error(grid, true), 0.05)
        self.assertNotIn("error", grid.cell_data)

    def test_every_number_of_ranks_writes_the_same(self):
        for options in (("--exchange", "links"), ("--exchange", "rays")):
            files = []
            for ranks in (1, 3):
                self.cornell("--target-error", 0.1, *options, ranks=ranks)
                files.append([(self.out / name).read_bytes() for name in ("solution.vtu", "solution.glb")])
            self.assertTrue(files[0] == files[1], options)  # a difference of them is too long to be told

    def test_a_dark_room_beside_a_bright_one(self):
        self.write("room.mtl", MTL)
        rooms = self.write("rooms.obj", TWO_ROOMS)
        for method in (("--target-error", 0.1), (*MATRIX, "--subdivision", "uniform", "--max-edge", 0.5)):
            with self.subTest(method=method):
                grid, (model, parts), _ = self.baked(rooms, *method, "--mesh-max-edge", 0.1)
                middles = np.array([grid.vertices[face[face >= 0]].mean(axis=0) for face in grid.faces])
                inside = {"": grid["radiosity"], "_back": grid["radiosity_back"]}
                partition = grid.of_group("partition")
                dark = (middles[:, 0] > 1) & ~partition
                self.assertEqual(sum(values[dark].sum() for values in inside.values()), 0)
                lit = (middles[:, 0] < 1) & ~partition
                self.assertTrue((sum(values[lit] for values in inside.values()) > 0).all())
                # Of the partition one side; of the floor vertices at its foot twice, with light and without.
                bright, other = sorted(inside.values(), key=lambda values: -values[partition].sum())
                self.assertTrue((bright[partition] > 0).all())
                self.assertEqual(other[partition].sum(), 0)
                lights = {}
                for name, positions, radiosities, _, _ in parts:
                    for position, B in zip(positions, radiosities, strict=True):
                        x = position[0] + model["nodes"][0]["translation"][0]
                        place = "foot" if abs(x - 1) < 1e-6 else "lit" if x < 1 else "dark"
                        lights.setdefault((name, place), []).append(max(B))
                self.assertEqual(min(lights["floor", "foot"]), 0)
                self.assertGreater(max(lights["floor", "foot"]), 0.1 * max(lights["floor", "lit"]))
                for name in ("floor", "ceiling", "walls"):
                    self.assertEqual(max(lights[name, "dark"]), 0)

    def test_heat(self):
        grid, _, report = self.baked(SCENES / "heating-chamber" / "heating-chamber.toml", "--mesh-max-edge", 0.5)
        self.assertGreater(len(grid), report["elements"] / 100)
        fronts = grid["sides"] & 1 > 0
        T, emissivity, B, H = (grid[name][fronts].astype(float).reshape(fronts.sum(), -1)[:, 0]
                               for name in ("temperature", "emissivity", "radiosity", "irradiance"))
        self.assertLess((abs(B - emissivity * 5.670374419e-8 * T**4 - (1 - emissivity) * H) / B).max(), 1e-4)

    def test_a_view_bakes_too(self):
        self.assert_done(self.solve(CORNELL, "--resolution", "16x16", "--target-error", 0.05, "--quiet"))
        job = start(["view", CORNELL, "--solution", self.out / "solution.ply", "--resolution", "16x16", "--write", "vtu",
                     "--mesh-max-edge", EDGE, "--out", self.work / "seen", "--quiet"], ranks=2)
        self.assertIn(job.code, (0, 3), job)
        grid = fluxel.read_grid(self.work / "seen" / "solution.vtu")
        for found, exact in zip(grid.areas @ grid["radiosity"], self.report()["leaving"], strict=True):
            self.assertAlmostEqual(found / exact, 1, delta=0.02)

    def test_a_view_without_a_camera(self):
        self.write("room.mtl", MTL)
        rooms, seen = self.write("rooms.obj", TWO_ROOMS), self.work / "seen"
        self.assert_done(self.solve(rooms, "--target-error", 0.1, "--quiet"))
        view = ["view", rooms, "--solution", self.out / "solution.ply", "--out", seen, "--write", "glb", "--target-error", 0.05]
        job = start(view, ranks=1)
        self.assertEqual((job.code, len(job.said)), (2, 1), job)
        self.assertIn("--mesh-max-edge", job.said[0])
        self.assert_done(start([*view, "--mesh-max-edge", 0.2], ranks=2))
        self.assertEqual({file.name for file in seen.iterdir()}, {"convergence.csv", "report.html", "report.json", "solution.glb"})
        sums = light_of_triangles(read_glb(seen / "solution.glb")[1])
        for found, exact in zip(sums, self.report()["leaving"], strict=True):
            self.assertAlmostEqual(found / exact, 1, delta=0.05)

    def test_what_is_refused(self):
        job = start(["solve", CORNELL, "--write", "glb", "--mesh-max-edge", 1e-4, "--out", self.out], ranks=2)
        self.assert_refused(job, "--mesh-max-edge", "2000000", "ask for a larger one")
        for value in ("0", "-1", "nan"):
            job = start(["solve", CORNELL, "--write", "glb", f"--mesh-max-edge={value}", "--out", self.out], ranks=1)
            self.assert_refused(job, "--mesh-max-edge")
        job = self.solve(CORNELL, "--resolution", "8x8", "--target-error", 0.3, "--mesh-max-edge", 0.1)
        self.assert_done(job)
        self.assertTrue(any("--mesh-max-edge has no effect" in line for line in job.warnings), job)
        self.assertNotIn("mesh_max_edge", self.report()["options"])


if __name__ == "__main__":
    unittest.main()
