"""Light meters of a solve, by both methods, against paths of light."""

import csv
import math
import unittest

from fluxel_job import MATRIX, SCENES, JobTest, start
from reference_files import read_exr

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
        layers = read_exr(folder / "receiver-desk.exr")[1]
        return list(zip(*layers[""], strict=True)), list(zip(*layers["error"], strict=True))

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
                            allowed = 3 * errors[k][colour] + stated[k][colour]
                            self.assertLess(abs(cell[colour] - values[k][colour]), allowed, (k, colour, cell, values[k]))
                            self.assertGreater(stated[k][colour], 0)
                            self.assertLess(stated[k][colour], 0.25 * cell[colour])
                    with open(out / "receivers.csv", newline="", encoding="utf-8") as file:
                        rows = list(csv.DictReader(file))
                    self.assertEqual(len(rows), 4)
                    for k, row in enumerate(rows):
                        self.assertTrue(math.isclose(float(row["irradiance_r"]), found[k][0], rel_tol=1e-5))

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
