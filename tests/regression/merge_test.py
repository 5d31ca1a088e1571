"""Coplanar polygons are merged: a tessellated scene is the one of whole walls."""

import csv
import unittest

from fluxel_job import JobTest, start
from rooms import MTL

CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
FACES = {"floor": (0, 1, 3, 2), "front": (0, 4, 5, 1), "back": (2, 3, 7, 6), "left": (0, 2, 6, 4), "right": (1, 5, 7, 3),
         "ceiling": (4, 6, 7, 5)}  # normals point inward
UNIFORM = ("--subdivision", "uniform", "--max-edge", "0.3", "--sides", "one", "--no-error-estimate")


def cube(low, high, inward):
    """{group: corners of its face}."""
    at = [[a + (b - a) * t for t in corner] for corner, a, b in ((c, low, high) for c in CORNERS)]
    return {name: [at[k] for k in (face if inward else face[::-1])] for name, face in FACES.items()}


def triangles(face, cells):
    """A parallelogram as cells x cells parallelograms, each of two triangles."""
    a, b, c, d = face

    def point(i, j):
        return c if i == j == cells else [p + (q - p) * i / cells + (r - p) * j / cells for p, q, r in zip(a, b, d)]

    for i in range(cells):
        for j in range(cells):
            quad = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]
            yield [quad[0], quad[1], quad[2]]
            yield [quad[0], quad[2], quad[3]]


def room(cells=0, box=True):
    """An OBJ text of a room with a box on its floor, tessellated where cells are given."""
    parts = cube(0, 1, True)
    if box:
        parts |= {"box " + name: face for name, face in cube(0.25, 0.5, False).items()}
    lines, numbers = ["mtllib room.mtl"], {}
    for group, face in parts.items():
        lines += [f"g {group.replace(' ', '_')}", "usemtl " + ("light" if group == "ceiling" else "white")]
        for polygon in triangles(face, cells) if cells else [face]:
            words = []
            for corner in map(tuple, polygon):
                if corner not in numbers:
                    numbers[corner] = len(numbers) + 1
                    lines.append("v {:.17g} {:.17g} {:.17g}".format(*corner))
                words.append(str(numbers[corner]))
            lines.append("f " + " ".join(words))
    return "\n".join(lines) + "\n"


class MergeTest(JobTest):
    def setUp(self):
        super().setUp()
        self.write("room.mtl", MTL)
        self.whole = self.write("whole.obj", room())
        self.cells = self.write("cells.obj", room(4))

    def solved(self, scene, *arguments, ranks=2):
        self.assert_done(self.solve(scene, *UNIFORM, *arguments, ranks=ranks))
        return self.report()

    def test_the_same_solution_as_of_whole_walls(self):
        whole = self.solved(self.whole)
        solution = (self.out / "solution.ply").read_bytes()
        self.assertEqual((whole["patches"], whole["scene"]["merged_patches"]), (12, 0))
        self.assertEqual(whole["options"]["keep_polygons"], False)
        for cells, ranks in ((1, 1), (4, 1), (4, 3)):
            with self.subTest(cells=cells, ranks=ranks):
                report = self.solved(self.write("cells.obj", room(cells)), ranks=ranks)
                self.assertEqual(report["scene"]["merged_patches"], 12 * 2 * cells**2 - 12)
                for key in ("patches", "elements", "hash"):
                    self.assertEqual(report[key], whole[key])
                self.assertTrue((self.out / "solution.ply").read_bytes() == solution, "solution.ply differs")
                self.assertEqual(report["scene"]["mesh_closed"], True)
                self.assertIn(f"{12 * 2 * cells**2} coplanar polygons merged into 12", " ".join(report["notes"]))

    def test_polygons_may_be_kept(self):
        for arguments in (("--keep-polygons",), ("--no-cut",)):
            with self.subTest(arguments):
                report = self.solved(self.cells, *arguments)
                self.assertEqual((report["patches"], report["scene"]["merged_patches"]), (12 * 32, 0))
                self.assertEqual(report["options"]["keep_polygons"], True)
        self.assert_done(self.solve(self.cells, "--subdivision", "none", "--no-error-estimate"))
        self.assertEqual(self.report()["elements"], 12 * 32)
        self.assert_done(self.solve(self.cells, *UNIFORM, "--dry-run"))
        self.assertEqual(self.report()["patches"], 12)

    def test_merging_changes_the_solution_by_its_error(self):
        absorbed = [sum(self.solved(self.cells, *arguments, "--max-edge", "0.125")["energy"]["absorbed"])
                    for arguments in ((), ("--keep-polygons",))]
        self.assertNotEqual(absorbed[0], absorbed[1])
        self.assertAlmostEqual(absorbed[0] / absorbed[1], 1, delta=0.002)

    def test_a_convex_room_is_known_as_one(self):
        for box in (False, True):
            with self.subTest(box=box):
                job = self.solve(self.write("some.obj", room(3, box)), *UNIFORM)
                self.assert_done(job)
                self.assertEqual(self.report()["scene"]["convex"], not box)
                self.assertEqual("note: convex: " in job.out, not box)

    def test_a_reference_has_the_same_patches(self):
        truth = self.work / "truth"
        for arguments in ((), ("--keep-polygons",)):
            with self.subTest(arguments):
                self.solved(self.cells, *arguments)
                solution = self.out / "solution.ply"
                measure = ["reference", self.cells, "--sides", "one", "--elements", solution, "--rays", "1000", "--out",
                           truth]
                self.assert_done(start([*measure, *arguments]))
                self.assert_done(start(["compare", solution, truth / "reference.ply"]))
                if arguments:
                    self.assertIn("--keep-polygons", start(measure).err)

    def test_a_reference_of_a_scene_file_that_keeps_them(self):
        scene = self.write("cells.toml", '[[geometry]]\nfile = "cells.obj"\n[options]\nsubdivision = "none"\nsides = "one"\n')
        self.assert_done(self.solve(scene, "--no-error-estimate"))
        self.assert_done(start(["reference", scene, "--elements", self.out / "solution.ply", "--rays", "1000", "--out",
                                self.work / "truth"]))

    def test_view_factors_are_the_same(self):
        tables = []
        for scene, arguments in ((self.whole, ()), (self.cells, ()), (self.cells, ("--keep-polygons",))):
            table = self.work / "factors" / "view-factors.csv"
            job = start(["viewfactors", scene, "--out", table.parent, "--tolerance", "1e-2", *arguments])
            self.assert_done(job)
            self.assertEqual("merged into 12" in job.out, scene == self.cells and not arguments)
            tables.append(list(csv.DictReader(table.read_text().splitlines())))
        self.assertEqual(tables[0], tables[1])
        self.assertEqual([row["to"] for row in tables[0]], [row["to"] for row in tables[2]])
        for whole, kept in zip(tables[0], tables[2]):
            self.assertAlmostEqual(float(whole["view_factor"]), float(kept["view_factor"]), delta=0.01)


if __name__ == "__main__":
    unittest.main()
