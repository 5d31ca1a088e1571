"""No length, area or power is large or small by itself: a scene in any unit has the same elements, bits and light.

In a unit that is a power of two nothing is rounded differently, so that all digits are the same.
"""

import csv
import json
import math
import unittest

from fluxel_job import SCENES, JobTest, start
from result_files import radiosities, read_exr

SMALLEST, LARGEST = 2.0**-29, 2.0**29  # of the Cornell box: 1 nm and 300,000 km
FAINTEST, BRIGHTEST = 2.0**-60, 2.0**40
NO_ESTIMATE = "--no-error-estimate"


class Room:
    """A scene whose unit and light can be set. Lengths in metres, exitances in W/m2."""

    def __init__(self, obj, metres_per_unit, light, exitance, eye, look_at, up, fov, sides, max_edge):
        self.obj, self.metres_per_unit = SCENES / obj, metres_per_unit
        self.light, self.exitance = light, exitance
        self.eye, self.look_at, self.up, self.fov = eye, look_at, up, fov
        self.sides, self.max_edge = sides, max_edge

    def text(self, scale, brightness):
        times = lambda numbers, factor: [float(x) * factor for x in numbers]
        return f"""[[geometry]]
file = "{self.obj}"
metres_per_unit = {self.metres_per_unit * scale}

[materials.{self.light}]
E = {times(self.exitance, brightness)}

[camera]
eye = {times(self.eye, scale)}
look_at = {times(self.look_at, scale)}
up = {times(self.up, 1)}
fov = {self.fov}
resolution = [16, 16]

[options]
sides = "{self.sides}"
max-edge = {self.max_edge * scale}
"""


CORNELL = Room("cornell-box/cornell-box.obj", 0.001, "light", [math.pi * x for x in (17, 12, 4)],
               (0.278, 0.273, -0.8), (0.278, 0.273, 0), (0, 1, 0), 39.3076, "one", 0.125)
# Surfaces that touch, coincide and stand on one another; edges that are as long as the longest asked for.
WOOD = Room("construction-in-wood/construction-in-wood.obj", 1, "window", (40, 40, 38),
            (2, -2.35, 1.4), (2, 2, 1.4), (0, 0, 1), 56, "two", 0.8)


class Result:
    def __init__(self, out):
        self.report = json.loads((out / "report.json").read_text())
        self.B = [value for face in radiosities(out / "solution.ply") for value in face]
        self.picture = (out / "image.png").read_bytes()

    @property
    def counts(self):
        report = self.report
        return {"elements": report["elements"], "unknowns": report["unknowns"], "pieces": report["scene"]["pieces"],
                "iterations": report["solve"]["iterations"]}

    @property
    def without_unit(self):
        """All that is found and done and has no unit."""
        report = self.report
        return {**self.counts, "bits": report["hash"]["visibility"], "near": report["form_factor"]["near_pairs"],
                "estimate": report.get("error_estimate"), "defect": report["energy"]["defect_relative"],
                "bound": report["solve"]["error_bound"]}


class ScaleTest(JobTest):
    def scene(self, room, scale, brightness):
        return self.write("scene.toml", room.text(scale, brightness))

    def solved(self, room, *arguments, scale=1.0, brightness=1.0):
        self.assert_done(self.solve(self.scene(room, scale, brightness), "--quiet", *arguments, ranks=1))
        return Result(self.out)

    def check_the_same(self, room, *arguments, scales=(1.0,), brightnesses=(1.0,)):
        """Every digit, but for the power of two that B is multiplied by."""
        first = self.solved(room, *arguments)
        for scale in scales:
            for brightness in brightnesses:
                with self.subTest(arguments=arguments, scale=math.log2(scale), brightness=math.log2(brightness)):
                    other = self.solved(room, *arguments, scale=scale, brightness=brightness)
                    self.assertEqual(other.without_unit, first.without_unit)
                    self.assertTrue(other.B == [brightness * value for value in first.B], "B differs")
                    self.assertTrue(other.picture == first.picture, "the picture differs")

    def test_powers_of_two_of_the_unit(self):
        for form_factor in ("adaptive", "disc", "point", "points:2x2"):
            self.check_the_same(CORNELL, "--form-factor", form_factor, scales=(SMALLEST, 2.0**20))
        self.check_the_same(CORNELL, "--subdivision", "uniform", scales=(2.0**-20, LARGEST))
        for form_factor in ("adaptive", "disc"):
            self.check_the_same(WOOD, "--form-factor", form_factor, NO_ESTIMATE, scales=(2.0**-20, 2.0**20))
        self.check_the_same(WOOD, "--subdivision", "uniform", scales=(SMALLEST, 2.0**20))

    def test_powers_of_two_of_the_light(self):
        self.check_the_same(CORNELL, brightnesses=(FAINTEST, BRIGHTEST))
        self.check_the_same(WOOD, "--subdivision", "uniform", NO_ESTIMATE, brightnesses=(FAINTEST, BRIGHTEST))

    def test_every_solver(self):
        for solver in ("gauss-seidel", "jacobi", "southwell"):
            arguments = ("--solver", solver, "--form-factor", "disc")
            self.check_the_same(CORNELL, *arguments, scales=(2.0**-20, 2.0**20), brightnesses=(FAINTEST,))

    def check_nearly_the_same(self, room, *arguments, largest, mean_square, scales):
        """Other numbers, other rounding; both errors over the mean B."""
        first = self.solved(room, *arguments)
        mean = sum(first.B) / len(first.B)
        for scale in scales:
            with self.subTest(arguments=arguments, scale=scale):
                other = self.solved(room, *arguments, scale=scale)
                self.assertEqual(other.counts, first.counts)
                errors = [abs(a - b) / mean for a, b in zip(other.B, first.B)]
                self.assertLess(max(errors), largest)
                self.assertLess(math.sqrt(sum(e * e for e in errors) / len(errors)), mean_square)

    def test_thousandths(self):
        self.check_nearly_the_same(CORNELL, "--form-factor", "disc", NO_ESTIMATE, scales=(1e-3, 1e3),
                                   largest=2e-5, mean_square=1e-6)
        # Rays that end on an edge fall on either side of it.
        self.check_nearly_the_same(CORNELL, NO_ESTIMATE, scales=(1e-6, 1e-3, 1e3, 1e6),
                                   largest=3e-4, mean_square=1e-5)
        self.check_nearly_the_same(WOOD, "--subdivision", "uniform", NO_ESTIMATE, scales=(1e-3, 1e3),
                                   largest=2e-2, mean_square=5e-4)
        # Pixels that look at a dividing line, too.
        self.check_nearly_the_same(WOOD, "--resolution", "24x24", "--form-factor", "disc", NO_ESTIMATE,
                                   scales=(1e-3, 1e3), largest=0.15, mean_square=5e-3)

    def test_references(self):
        def measured(scale, brightness):
            out = self.work / "reference"
            job = start(["reference", self.scene(CORNELL, scale, brightness), "--rays", 1e5, "--out", out, "--quiet"],
                        ranks=1)
            self.assert_done(job)
            layers = read_exr(out / "reference.exr")
            return {name: layers[name] for name in ("R", "G", "B", "error.R", "error.G", "error.B")}

        first = measured(1.0, 1.0)
        self.assertGreater(max(max(row) for row in first["R"]), 1)
        for scale, brightness in ((2.0**-20, 1.0), (2.0**20, 1.0), (1.0, FAINTEST), (1.0, BRIGHTEST)):
            with self.subTest(scale=scale, brightness=brightness):
                other = measured(scale, brightness)
                for name, rows in first.items():
                    self.assertTrue(other[name] == [[brightness * x for x in row] for row in rows], name)

    def test_view_factors(self):
        def rows(scale):
            table = self.work / "factors" / "view-factors.csv"
            self.assert_done(start(["viewfactors", self.scene(CORNELL, scale, 1.0), "--tolerance", 0.01, "--out", table.parent,
                                    "--quiet"], ranks=1))
            with table.open(newline="") as file:
                return list(csv.DictReader(file))

        first = rows(1.0)
        self.assertGreater(len(first), 20)
        for scale in (2.0**-20, 2.0**20):
            with self.subTest(scale=scale):
                for was, row in zip(first, rows(scale), strict=True):
                    self.assertEqual([row[key] for key in ("from", "to", "view_factor", "error_estimate")],
                                     [was[key] for key in ("from", "to", "view_factor", "error_estimate")])
                    self.assertAlmostEqual(float(row["area_from_m2"]) / scale**2 / float(was["area_from_m2"]), 1,
                                           places=5)


if __name__ == "__main__":
    unittest.main()
