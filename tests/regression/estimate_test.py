"""What a run says of its own error."""

import math
import signal
import time
import unittest

from fluxel_job import MATRIX, SCENES, JobTest, finish, launch
from result_files import radiosities

CORNELL = (SCENES / "cornell-box" / "cornell-box.toml", "--resolution", "32x32")
WALL = (SCENES / "emitting-wall" / "emitting-wall.toml", "--tolerance", "1e-5", "--resolution", "8x8")
BOXES = (SCENES / "room-of-boxes" / "room-of-12-boxes.toml", "--resolution", "80x80")


class EstimateTest(JobTest):
    def test_meshes_become_coarser(self):
        job = self.solve(*CORNELL)
        self.assert_done(job)
        report = self.report()
        estimate = report["error_estimate"]
        self.assertEqual(estimate["elements"][0], report["elements"])
        for finer, coarser in zip(estimate["elements"], estimate["elements"][1:]):
            self.assertLess(coarser, finer / 3)
            self.assertGreater(coarser, finer / 6)
        self.assertEqual(estimate["convergence_rgb"], report["solve"]["error_bound_rms_rgb"])
        self.assertGreater(report["time_s"]["estimate"], 0)
        self.assertEqual(sum(line.startswith("error estimate: ") for line in job.out.splitlines()), 1, str(job))

    def test_of_an_emitting_wall_it_is_the_error(self):
        # Walls of 8 x 8 squares against the means of the same walls of 64 x 64, whose own error is well below a tenth.
        self.assert_done(self.solve(*WALL, "--max-edge", 1.001 / 64, "--no-error-estimate"))
        fine = [face[0] for face in radiosities(self.out / "solution.ply")]
        self.assert_done(self.solve(*WALL, "--max-edge", 1.001 / 8))
        coarse = [face[0] for face in radiosities(self.out / "solution.ply")]
        means = [sum(fine[64 * i:64 * i + 64]) / 64 for i in range(len(coarse))]
        true = math.sqrt(sum((a - b) ** 2 for a, b in zip(coarse, means)) / len(coarse)) / (sum(coarse) / len(coarse))
        estimate = self.report()["error_estimate"]["discretisation_rgb"][0]
        self.assertGreater(estimate, 0.7 * true)
        self.assertLess(estimate, 1.5 * true)

    def test_without_it_the_iteration_starts_from_what_emits(self):
        """Both come to the same light, but for their iterations' errors and those of form factors."""
        self.assert_done(self.solve(*CORNELL))
        nested = self.report()
        solution = radiosities(self.out / "solution.ply")
        job = self.solve(*CORNELL, "--no-error-estimate")
        self.assert_done(job)
        report = self.report()
        self.assertLess(nested["solve"]["iterations"], report["solve"]["iterations"])
        for colour in range(3):
            other = [face[colour] for face in radiosities(self.out / "solution.ply")]
            mean = sum(other) / len(other)
            differences = [(a[colour] - b) ** 2 for a, b in zip(solution, other)]
            bounds = sum(r["solve"]["error_bound_rms_rgb"][colour] for r in (nested, report))
            self.assertLess(math.sqrt(sum(differences) / len(other)) / mean, bounds + 1e-3)
        self.assertNotIn("error_estimate", report)
        self.assertNotIn("estimate", report["time_s"])
        self.assertNotIn("error estimate", job.out + job.err)

    def test_a_run_that_keeps_the_visibility_or_predicts_has_none(self):
        for option in (("--dry-run",), ("--visibility-only", "--checkpoint", self.work / "strips")):
            with self.subTest(option[0]):
                self.assert_done(self.solve(*CORNELL, *option))
                self.assertNotIn("error_estimate", self.report())

    def test_whole_patches_have_none(self):
        job = self.solve(*CORNELL, "--subdivision", "none")
        self.assert_done(job)
        estimate = self.report()["error_estimate"]
        self.assertIn("whole patches", estimate["why_none"])
        self.assertNotIn("discretisation_rgb", estimate)
        self.assertIn("no error estimate: ", job.out)
        self.assertEqual(self.report()["warnings"], [])

    def test_larger_elements_that_do_not_converge_are_a_warning(self):
        # Elements of a wall's eighth converge by the point rule at a reflectance of 0.9, those of its quarter diverge.
        job = self.solve(SCENES / "furnace" / "furnace-0.9.toml", *MATRIX, "--max-edge", 1.001 / 8, "--form-factor", "point")
        self.assert_done(job)
        why_none = "the solution on larger elements does not converge"
        self.assertEqual(self.report()["error_estimate"]["why_none"], why_none)
        self.assertIn(f"no error estimate: {why_none}", self.report()["warnings"])
        self.assertIn(f"warning: no error estimate: {why_none}", job.warnings)

    def test_gaps_that_elements_are_too_large_for_are_named_instead_of_an_estimate(self):
        self.write("slats.mtl", "newmtl slat\nKd 0.8 0.8 0.8\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n")
        corners = [(x, y, z) for z in (0.5, 0.56) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
        corners += [(1.5, 0, 0), (1.5, 0, 1), (1.5, 1, 1), (1.5, 1, 0)]
        self.write("slats.obj", "mtllib slats.mtl\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in corners) +
                   "usemtl slat\ng low\nf 1 2 3 4\ng high\nf 5 6 7 8\nusemtl lamp\ng lamp\nf 9 10 11 12\n")
        job = self.solve(self.work / "slats.obj", *MATRIX, "--sides", "two", "--subdivision", "uniform", "--max-edge", 0.25)
        self.assert_done(job)
        report = self.report()
        self.assertRegex(report["error_estimate"]["why_none"], r"between '(low' and 'high|high' and 'low)', 0.06 m apart")
        self.assertNotIn("discretisation_rgb", report["error_estimate"])
        self.assertIn(f"no error estimate: {report['error_estimate']['why_none']}", report["warnings"])

    def test_a_lamp_close_below_a_ceiling_that_reflects_nearly_all(self):
        """The ceiling is cut along the lamp's outline and row sums are made 1: it came out 23 % too dark."""
        self.write("room.mtl", "newmtl wall\nKd 0.99 0.99 0.99\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n")
        corners = [(x, y, z) for z in (0, 3) for y in (0, 5) for x in (0, 4)]
        corners += [(1.5, 2, 2.99), (1.5, 3, 2.99), (2.5, 3, 2.99), (2.5, 2, 2.99)]
        room = self.write("room.obj", "mtllib room.mtl\n" + "".join(f"v {x} {y} {z}\n" for x, y, z in corners) +
                          "usemtl wall\nf 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n"
                          "usemtl lamp\nf 9 10 11 12\n")
        for method in (MATRIX, ("--method", "hierarchical", "--target-error", 0.02)):
            with self.subTest(method=method):
                self.assert_done(self.solve(room, *method, "--eye", "1,4,1.5", "--look-at", "2,1,1.2", "--up", "0,0,1",
                                            "--fov", 60, "--resolution", "40x30"))
                report = self.report()
                bias = report["audit"]["bias"][1]
                self.assertLess(abs(bias["bias"]), 0.02 + bias["half_interval"])
                self.assertLess(bias["half_interval"], 0.02)

    def test_a_matrix_states_the_error_of_its_picture(self):
        """Not of its elements, which the picture shows as one shade each."""
        self.assert_done(self.solve(*CORNELL, *MATRIX))
        report = self.report()
        elements = max(report["error_estimate"]["discretisation_rgb"])
        self.assertGreater(report["stated_error"], 3 * elements)
        self.assertGreaterEqual(report["stated_error"], report["audit"]["error"]["value"])
        self.assertLessEqual(report["stated_error"], report["audit"]["error"]["high"])

    def test_a_solution_that_has_not_converged_has_none(self):
        self.assert_done(self.solve(*CORNELL, "--max-iterations", "1"), code=3)
        self.assertIn("not converged", self.report()["error_estimate"]["why_none"])

    def test_a_signal_after_the_solution_leaves_the_estimate(self):
        begin = time.monotonic()
        process = launch(["solve", *MATRIX, *BOXES, "--threads", "1", "--out", self.out])
        self.wait_for((self.out / "solution.ply").exists, process)
        process.send_signal(signal.SIGUSR2)
        self.assert_done(finish(process, begin))
        report = self.report()
        self.assertGreater(report["error_estimate"]["discretisation_rgb"][0], 0)
        self.assertTrue(report["solve"]["converged"])


if __name__ == "__main__":
    unittest.main()
