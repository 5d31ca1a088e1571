"""Numbers that people sign: each was once far off, with a small error or none beside it."""

import csv
import json
import math
import unittest

from fluxel_job import JobTest, start

# A room of 4 x 4 x 3 m below a bright sky, with a square hole in the middle of its roof.
SKY = """units = "photometric"
[[geometry]]
box = [120, 120, 60]
inwards = true
group = "sky"
material = "sky"
translate = [-58, -58, -0.5]
[[geometry]]
file = "room.obj"
[materials.sky]
rho = 0
E = {exitance}
[materials.wall]
rho = {rho}
sides = "two"
[options]
ke = "exitance"
sides = "one"
"""


def room_below(hole):
    """The room's faces, around a hole of that size."""
    low, high = 2 - hole / 2, 2 + hole / 2
    faces = [[(0, 0, 0), (4, 0, 0), (4, 4, 0), (0, 4, 0)], [(0, 0, 0), (4, 0, 0), (4, 0, 3), (0, 0, 3)],
             [(0, 4, 0), (4, 4, 0), (4, 4, 3), (0, 4, 3)], [(0, 0, 0), (0, 4, 0), (0, 4, 3), (0, 0, 3)],
             [(4, 0, 0), (4, 4, 0), (4, 4, 3), (4, 0, 3)]]
    roof = [(0, 4, 0, low), (0, 4, high, 4), (0, low, low, high), (high, 4, low, high)]
    faces += [[(x0, y0, 3), (x1, y0, 3), (x1, y1, 3), (x0, y1, 3)] for x0, x1, y0, y1 in roof]
    text = "mtllib room.mtl\nusemtl wall\n"
    for k, face in enumerate(faces):
        text += f"g face{k}\n" + "".join("v {} {} {}\n".format(*corner) for corner in face) + "f -4 -3 -2 -1\n"
    return text


def points(name, place, normal=(0, 0, 1)):
    return f'[[receivers]]\nname = "{name}"\npoints = [{list(place)}]\nnormal = {list(normal)}\n'


class SingleNumbersTest(JobTest):
    def below_the_sky(self, hole, exitance, rho, receivers):
        self.write("room.mtl", "newmtl wall\nKd 0.5 0.5 0.5\n")
        self.write("room.obj", room_below(hole))
        return self.write("room.toml", SKY.format(exitance=exitance, rho=rho) + receivers)

    def values(self):
        with open(self.out / "receivers.csv", newline="", encoding="utf-8") as file:
            return {row["receiver"]: (float(row["value"]), float(row["error"])) for row in csv.DictReader(file)}

    def run_job(self, command, scene, *options, code=0):
        job = start([command, scene, *(["--only", "receivers"] if command == "reference" else []), *options, "--out", self.out])
        self.assertEqual(job.code, code, str(job))
        return job

    def test_a_hole_that_one_path_in_three_thousand_finds(self):
        """The configuration factor of a hole of 0.1 m, 3 m above the floor's middle."""
        scene = self.below_the_sky(0.1, 1e6, 0, points("middle", (2, 2, 0.0001)))
        a = 0.05 / (3 - 0.0001)
        exact = 1e6 * 4 / (2 * math.pi) * 2 * a / math.sqrt(1 + a * a) * math.atan(a / math.sqrt(1 + a * a))
        for command, seeds in (("solve", [None]), ("reference", range(1, 13))):
            for seed in seeds:
                self.run_job(command, scene, "--target-error", 0.05, *(["--seed", seed] if seed else []))
                value, error = self.values()["middle"]
                self.assertLess(abs(value - exact), 4 * error, (command, seed))
                self.assertLess(error, 0.055 * exact)

    def test_light_of_a_small_roof_light(self):
        """Four points, 0.4 % by references."""
        truth = {"p0": ((2, 2, 0.8), 68.17), "p1": ((1, 2, 0.8), 50.08), "p2": ((0.5, 0.5, 0.8), 25.96), "p3": ((3, 3, 0.8), 39.52)}
        scene = self.below_the_sky(0.3, 1e4, 0.5, "".join(points(name, place) for name, (place, _) in truth.items()))
        within = 0
        runs = [("solve", None)] + [("reference", seed) for seed in range(1, 13)]
        for command, seed in runs:
            self.run_job(command, scene, "--target-error", 0.05, *(["--seed", seed] if seed else []))
            for name, (value, error) in self.values().items():
                off = abs(value - truth[name][1]) / math.hypot(error, 0.004 * truth[name][1])
                self.assertLess(off, 4.5, (command, seed, name, value, error))
                within += off <= 1
        # Of 52 by Student's t 34.7 +- 3.4.
        self.assertGreater(within, 24)

    def test_what_no_path_finds_has_no_error(self):
        """A hole of 3 mm in the roof: what few paths have not found is not known."""
        scene = self.below_the_sky(0.003, 1e6, 0, points("corner", (0.01, 0.01, 2.99)))
        job = self.run_job("reference", scene, "--target-error", 0.05, "--rays", 20_000, code=3)
        report = json.loads((self.out / "reference.json").read_text())["measured"]["receiver corner"]
        self.assertFalse(report["reached"])
        self.assertNotIn("relative_error_rgb", report)
        self.assertNotIn("error", report["mean"])
        self.assertIn("error not known", job.out)

    def test_ends_of_a_line_lie_in_walls(self):
        line = '[[receivers]]\nname = "{}"\nfrom = [{}, 2, 0.8]\nto = [{}, 2, 0.8]\ncount = 9\nnormal = [0, 0, 1]\n'
        scene = self.write("line.toml", 'units = "photometric"\n[[geometry]]\nbox = [4, 4, 3]\ninwards = true\nmaterial = "w"\n'
                           '[materials.w]\nrho = 0.5\n[[geometry]]\nrectangle = [1, 1]\nmaterial = "l"\nrotate = [1, 0, 0, 180]\n'
                           'translate = [1.5, 2.5, 2.9]\n[materials.l]\nrho = 0\nE = 10000\n' + line.format("across", 0, 4)
                           + line.format("inside", 1e-4, 3.9999))
        for command, report in (("solve", "report.json"), ("reference", "reference.json")):
            job = self.run_job(command, scene, "--target-error", 0.02)
            self.assertIn("'across': 2 of its 9 points lie in a surface", job.out)
            text = json.loads((self.out / report).read_text())
            across, inside = ((text["receivers"][name] if command == "solve" else text["measured"][f"receiver {name}"])["u0"]
                              for name in ("across", "inside"))
            self.assertAlmostEqual(across["value"], 0.605, delta=4 * across["error"])
            self.assertAlmostEqual(inside["value"], 0.605, delta=4 * inside["error"])

    def test_a_luminaire_close_to_the_ceiling(self):
        """Half of its light falls on a spot of a tenth of a millimetre, which photons find: 38.7 lx."""
        scene = self.write("near.toml", 'units = "photometric"\n[[geometry]]\nbox = [4, 4, 3]\ninwards = true\nmaterial = "w"\n'
                           '[materials.w]\nrho = 0.5\n[[luminaires]]\nname = "a"\nintensity = 100.0\nposition = [2, 2, 2.9999]\n'
                           '[[receivers]]\nname = "r"\norigin = [0.5, 0.5, 0.8]\nu = [3, 0, 0]\nv = [0, 3, 0]\ncells = [4, 4]\n')
        for command, report in (("solve", "report.json"), ("reference", "reference.json")):
            self.run_job(command, scene, "--target-error", 0.1)
            text = json.loads((self.out / report).read_text())
            mean = (text["receivers"]["r"] if command == "solve" else text["measured"]["receiver r"])["mean"]
            self.assertAlmostEqual(mean["value"], 38.7, delta=4 * math.hypot(mean["error"], 0.1))
            self.assertLess(mean["error"], 2)

    def test_a_closed_room_just_above_bright_ground(self):
        """They count as one plane, beside a ground of 800 m: the floor covers the ground, and no light comes in."""
        scene = self.write("ground.toml", 'units = "photometric"\n[[geometry]]\nbox = [4, 4, 3]\ngroup = "room"\nmaterial = "black"\n'
                           'inwards = true\n[[geometry]]\nrectangle = [800, 800]\ngroup = "ground"\nmaterial = "ground"\n'
                           'translate = [-400, -400, -0.001]\n[materials.black]\nrho = 0\nsides = "two"\n[materials.ground]\nrho = 0\n'
                           'E = 3000\n[options]\nke = "exitance"\nsides = "one"\n' + points("ceiling", (2, 2, 2.9), (0, 0, -1)))
        job = self.run_job("solve", scene, code=3)
        self.assertEqual(self.values()["ceiling"][0], 0)
        self.assertTrue(any("'room -z' lies 0.001 m from 'ground'" in warning for warning in job.warnings), str(job))

    def test_rings_close_tubes(self):
        self.write("can.rad", "void plastic m\n0\n0\n5 .5 .5 .5 0 0\nm ring bottom\n0\n0\n8 0 0 0 0 0 1 0 1\n"
                   "m ring top\n0\n0\n8 0 0 1 0 0 -1 0 1\nm tube side\n0\n0\n7 0 0 0 0 0 1 1\n")
        job = start(["viewfactors", self.work / "can.rad", "--out", self.out])
        self.assert_done(job)
        with open(self.out / "view-factors.csv", newline="", encoding="utf-8") as file:
            factors = {(row["from"], row["to"]): float(row["view_factor"]) for row in csv.DictReader(file)}
        self.assertAlmostEqual(factors["bottom", "top"], (3 - math.sqrt(5)) / 2, delta=1e-4)
        for name in ("bottom", "top", "side"):
            self.assertAlmostEqual(sum(value for (of, _), value in factors.items() if of == name), 1, delta=1e-5)

    def test_net_heat_of_an_oven(self):
        """A cube of 1 m, its floor at 1000 K, its ceiling at 500 K, its walls adiabatic: 19,091 W by elements of 0.05 m."""
        scene = self.write("oven.toml", 'temperature_unit = "celsius"\n[[geometry]]\nbox = [1, 1, 1]\ninwards = true\ngroup = "oven"\n'
                           'material = "adiabatic"\nmaterial_of = { "-z" = "hot", "+z" = "cold" }\n[materials]\n'
                           'hot = { emissivity = 0.8, temperature = 727 }\ncold = { emissivity = 0.6, temperature = 227 }\n'
                           'adiabatic = { emissivity = 0.9, heat_flux = 0 }\n[options]\nthermal = true\nsides = "one"\n')
        self.run_job("solve", scene)
        rows = {row["group"]: row for row in json.loads((self.out / "report.json").read_text())["thermal"]}
        for name, net in (("oven -z", 19_091), ("oven +z", -19_091)):
            self.assertLess(abs(rows[name]["net_w"] - net), rows[name]["error_w"] + 10, rows[name])
            self.assertLess(rows[name]["error_w"], 0.03 * abs(net))


if __name__ == "__main__":
    unittest.main()
