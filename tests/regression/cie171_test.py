"""Cases 5.3, 5.4, 5.6 to 5.8 in the style of CIE 171:2006 against closed forms: see bench/cie171.py."""

import unittest

from fluxel_job import SCENES, JobTest

import cie171
import fluxel
from scene_parts.mesh import point_factor

# A point's light comes in few pairs; flux and means are sums over many, where errors without a trend cancel.
POINT_TOLERANCE = 2e-3
FLUX_TOLERANCE = 1e-3

# One element for the small patch, 2 x 2 for the lamp: the pair rule has to be right, not the elements small.
COARSE = ("--max-edge", "0.501")


class Cie171Test(JobTest):
    def check(self, case, tolerance, *options):
        def solve(scene):
            file = SCENES / "cie171" / f"{scene}.toml"
            self.assert_done(self.solve(file, *options, "--threads", 1, "--quiet"))
            return fluxel.read_elements(self.out / "solution.ply")

        for row in cie171.CASES[case](solve):
            with self.subTest(quantity=row.quantity):
                self.assertLess(abs(row.error), tolerance, " ".join(row.cells()))

    def test_points_under_an_area_source(self):
        self.check("5.3-area-source", POINT_TOLERANCE, *COARSE)

    def test_light_of_a_small_patch(self):
        self.check("5.6-small-patch", POINT_TOLERANCE, *COARSE)

    def test_light_of_a_whole_floor(self):
        self.check("5.6-whole-floor", POINT_TOLERANCE, *COARSE)

    def test_shadow_of_an_obstruction(self):
        self.check("5.7-obstruction", POINT_TOLERANCE)

    def test_flux_of_a_pane(self):
        self.check("5.4-pane", FLUX_TOLERANCE)

    def test_flux_through_an_opening(self):
        self.check("5.4-opening", FLUX_TOLERANCE)

    def test_reflected_light_in_a_cube(self):
        self.check("5.8-cube", FLUX_TOLERANCE)

    def test_the_closed_forms_are_those_of_lambert(self):
        for case in cie171.scenes.POINT_CASES:
            for receiver in case.receivers:
                for part in case.visible(receiver.point):
                    expected = point_factor(receiver.point, receiver.normal, part.face())
                    found = cie171.configuration_factor(receiver.point, receiver.normal, part)
                    self.assertAlmostEqual(found / expected, 1, delta=1e-12)


if __name__ == "__main__":
    unittest.main()
