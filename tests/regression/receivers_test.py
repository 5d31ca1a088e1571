"""Light meters of a solve, by both methods, against paths of light."""

import csv
import json
import math
import unittest

from fluxel_job import MATRIX, SCENES, JobTest, start
from result_files import read_exr

# A meter in each scene, where light arrives directly and from other surfaces.
METERS = {"cornell-box": ((0.1, 0.1, 0.1), (0.3, 0, 0), (0, 0, -0.08)),
          "courtyard": ((2, 0.5, 2), (0, 0, 2), (2, 0, 0)),
          "office-2391": ((1, 1, 1), (0, 0, 1), (1, 0, 0))}


class ReceiversTest(JobTest):
    method = ()

    def scene(self, name):
        text = (SCENES / name / f"{name}.toml").read_text()
        text = text.replace('file = "', f'file = "{SCENES / name}/')
        origin, u, v = METERS[name]
        meter = (f'[[receivers]]\nname = "desk"\norigin = {list(origin)}\nu = {list(u)}\nv = {list(v)}\n'
                 "cells = [2, 2]\n\n")
        return self.write(f"{name}.toml", text.replace("[options]", meter + "[options]", 1))

    def cells(self, folder):
        image = read_exr(folder / "receiver-desk.exr")
        channels = {name: [x for row in rows for x in row] for name, rows in image.items()}
        return [list(zip(*(channels[prefix + c] for c in "RGB"), strict=True)) for prefix in ("", "error.")]

    def test_both_methods_agree_with_paths_of_light(self):
        for name in METERS:
            scene = self.scene(name)
            truth = self.work / "truth"
            job = start(["reference", scene, "--only", "receivers", "--target-error", 0.005, "--out", truth])
            self.assert_done(job)
            values, errors = self.cells(truth)
            for method in (["--target-error", 0.05], [*MATRIX]):
                with self.subTest(scene=name, method=method):
                    out = self.work / "solved"
                    self.assert_done(start(["solve", scene, *method, "--resolution", "24x24", "--out", out]))
                    found, stated = self.cells(out)
                    for k, cell in enumerate(found):
                        for colour in range(3):
                            allowed = 4 * math.hypot(errors[k][colour], stated[k][colour])
                            self.assertLess(abs(cell[colour] - values[k][colour]), allowed, (k, colour, cell, values[k]))
                            self.assertGreater(stated[k][colour], 0)
                            self.assertLess(stated[k][colour], 0.25 * cell[colour])
                    with open(out / "receivers.csv", newline="", encoding="utf-8") as file:
                        rows = list(csv.DictReader(file))
                    self.assertEqual(len(rows), 4)
                    for k, row in enumerate(rows):
                        self.assertTrue(math.isclose(float(row["value_r"]), found[k][0], rel_tol=1e-5))

    def test_figures_are_those_of_the_table(self):
        scene = self.scene("cornell-box")
        for command, report in (("solve", "report.json"), ("reference", "reference.json")):
            with self.subTest(command):
                options = ["--only", "receivers"] if command == "reference" else ["--resolution", "8x8"]
                job = start([command, scene, "--target-error", 0.1, *options, "--out", self.out])
                self.assert_done(job)
                figures = json.loads((self.out / report).read_text())
                figures = figures["receivers"]["desk"] if command == "solve" else figures["measured"]["receiver desk"]
                values, errors = ([0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in layer] for layer in self.cells(self.out))
                least, most, mean = min(values), max(values), sum(values) / len(values)
                found = {name: figures[name]["value"] for name in ("mean", "min", "max", "u0", "ud")}
                # Extremes may be less so than those of the cells, which noise makes more extreme.
                for name, value, sign in (("min", least, 1), ("max", most, -1)):
                    self.assertGreater(sign * (found[name] - value), -1e-5 * value)
                    self.assertLess(sign * (found[name] - value), figures[name]["error"])
                    self.assertGreater(figures[name]["error"], 0.97 * errors[values.index(value)])
                for name, value in {"mean": mean, "u0": found["min"] / mean, "ud": found["min"] / found["max"]}.items():
                    self.assertTrue(math.isclose(found[name], value, rel_tol=1e-5), name)
                if command == "solve":
                    self.assertIn(f"receiver desk: mean {mean:.4g} +- ", job.out)
                    self.assertIn(f", min {found['min']:.4g} +- ", job.out)

    def test_errors_are_those_of_the_closed_form(self):
        """A point of 100 cd in a black room: cells differ from their exact means by as much as is stated."""
        corners = [(x, y, z) for z in (0, 3) for y in (0, 4) for x in (0, 4)]
        faces = ("1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4")
        self.write("room.mtl", "newmtl black\nKd 0 0 0\n")
        self.write("room.obj", "mtllib room.mtl\nusemtl black\n" + "".join("v {} {} {}\n".format(*corner) for corner in corners)
                   + "".join(f"f {face}\n" for face in faces))
        scene = self.write("room.toml", 'units = "photometric"\n[[geometry]]\nfile = "room.obj"\n[[luminaires]]\nname = "a"\n'
                           'intensity = 100.0\nposition = [1.3, 1.7, 1.0]\n[[receivers]]\nname = "desk"\norigin = [0.5, 0.5, 0.8]\n'
                           "u = [3, 0, 0]\nv = [0, 3, 0]\ncells = [12, 12]\n")
        self.assert_done(start(["solve", scene, "--target-error", 0.05, "--out", self.out]))
        steps, edge, height, squares = 50, 0.25, 0.2, 0
        with open(self.out / "receivers.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            x, y = (float(row[f"{axis}_m"]) - 0.5 * edge for axis in "xy")
            places = [(k + 0.5) * edge / steps for k in range(steps)]
            exact = sum(100 * height / ((x + s - 1.3)**2 + (y + t - 1.7)**2 + height**2)**1.5
                        for s in places for t in places) / steps**2
            squares += ((float(row["value_r"]) - exact) / float(row["error_r"]))**2
        self.assertEqual(len(rows), 144)
        # Of 144 t-distributed numbers of 15 degrees of freedom: 1.07 +- 0.07.
        self.assertLess(abs(math.sqrt(squares / len(rows)) - 1.07), 0.25)

    def test_light_that_varies_over_an_element(self):
        """A lamp over a floor of one element: what meters above the floor get from it is not constant over it."""
        self.write("room.mtl", "newmtl wall\nKd .8 .8 .8\nnewmtl lamp\nKd 0 0 0\nKe 9 9 9\n")
        self.write("room.obj", """mtllib room.mtl
v 0 0 5
v 4 0 5
v 4 0 0
v 0 0 0
v 1.5 2 2
v 2.5 2 2
v 2.5 2 3
v 1.5 2 3
g floor
usemtl wall
f 1 2 3 4
g lamp
usemtl lamp
f 5 6 7 8
""")
        scene = self.write("lamp.toml", '[[geometry]]\nfile = "room.obj"\n[[receivers]]\nname = "desk"\n'
                           'origin = [1, 0.3, 1]\nu = [2, 0, 0]\nv = [0, 0, 3]\ncells = [2, 2]\n')
        self.assert_done(start(["reference", scene, "--only", "receivers", "--target-error", 0.004, "--out", self.out]))
        values, errors = self.cells(self.out)
        self.assert_done(start(["solve", scene, "--out", self.work / "solved"]))
        found, stated = self.cells(self.work / "solved")
        for k in range(4):
            self.assertLess(abs(found[k][0] - values[k][0]), 3 * errors[k][0] + stated[k][0])

    def test_files_of_a_meter_that_is_no_more_go(self):
        scene = self.scene("cornell-box")
        small = ("--target-error", 0.3, "--resolution", "8x8")
        self.assert_done(self.solve(scene, *small))
        self.assertTrue((self.out / "receiver-desk.exr").exists())
        self.assert_done(self.solve(SCENES / "cornell-box" / "cornell-box.toml", *small))
        self.assertFalse((self.out / "receiver-desk.exr").exists())
        self.assertFalse((self.out / "receivers.csv").exists())

    def test_every_number_of_ranks_gives_the_same_bytes(self):
        scene = self.scene("cornell-box")
        of_ranks = []
        for ranks in (1, 3):
            job = self.solve(scene, "--target-error", 0.3, "--resolution", "8x8", "--threads", 1, ranks=ranks)
            self.assert_done(job)
            of_ranks.append((self.out / "receivers.csv").read_bytes())
        self.assertEqual(*of_ranks)


if __name__ == "__main__":
    unittest.main()
