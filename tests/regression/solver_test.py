"""Solvers, when they end, warm starts, early pictures, instruction sets."""

import re
import unittest

from fluxel_job import SCENES, JobTest
from result_files import radiosities
from rooms import MTL, ROOM

CORNELL = (SCENES / "cornell-box" / "cornell-box.toml", "--resolution", "32x32")
SOLVERS = ("jacobi", "gauss-seidel", "cg", "southwell")


def largest_difference(a, b):
    """Over the mean of a, which is near the area-mean, for each colour, or over the face's own where that is more: the last bit of
    a lamp is 1e-5 of the mean."""
    mean = [sum(face[c] for face in a) / len(a) for c in range(3)]
    return max(abs(x[c] - y[c]) / max(mean[c], x[c]) for x, y in zip(a, b) for c in range(3))


class SolverTest(JobTest):
    def run_with(self, *arguments, name="out", **settings):
        """The report's `solve` and the radiosities."""
        self.out = self.work / name
        self.assert_done(self.solve(*arguments, **settings))
        return self.report()["solve"], radiosities(self.out / "solution.ply")

    def assert_balanced(self, solve, share):
        self.assertTrue(solve["converged"])
        for bound, error in zip(solve["error_bound_rms_rgb"], solve["variation_rgb"]):
            self.assertGreater(error, 0)
            self.assertLessEqual(bound, share * error)

    def test_all_solvers_agree(self):
        tolerance = 1e-4
        _, exact = self.run_with(*CORNELL, "--tolerance", 3e-5)
        for solver in SOLVERS:
            with self.subTest(solver):
                solve, B = self.run_with(*CORNELL, "--solver", solver, "--tolerance", tolerance, ranks=1)
                self.assertEqual(solve["solver"], solver)
                self.assertTrue(solve["converged"])
                self.assertLessEqual(solve["error_bound"], tolerance)
                self.assertEqual(solve["error_bound"], max(solve["error_bound_rgb"]))
                self.assertEqual(solve["channels"], 3)
                self.assertNotIn("why", solve)
                # Each is within the tolerance of the area-mean, which is 0.6 of that over the elements.
                self.assertLess(largest_difference(exact, B), 2 * tolerance)

    def test_gauss_seidel_across_ranks_has_a_name_of_its_own(self):
        solve, _ = self.run_with(*CORNELL, "--solver", "gauss-seidel", ranks=2)
        self.assertIn("block", solve["solver"])

    def test_the_choice_is_explained(self):
        solve, _ = self.run_with(*CORNELL)
        self.assertEqual(solve["solver"], "cg")
        self.assertRegex(solve["why"], r"spectral radius is at most 0\.\d+")

    def test_the_iteration_ends_at_a_share_of_the_discretisation_error(self):
        tenth, _ = self.run_with(*CORNELL)
        hundredth, _ = self.run_with(*CORNELL, "--tolerance", "auto:0.01")
        self.assert_balanced(tenth, 0.1)
        self.assert_balanced(hundredth, 0.01)
        self.assertGreater(hundredth["iterations"], tenth["iterations"])
        self.assertGreater(tenth["error_bound"], 1e-4, "and not further")
        by_number, _ = self.run_with(*CORNELL, "--tolerance", "1e-3")
        self.assertLessEqual(by_number["error_bound"], 1e-3)
        self.assertNotIn("variation_rgb", by_number)

    def test_the_report_has_the_tolerance_that_was_in_force(self):
        share, _ = self.run_with(*CORNELL)
        self.assertNotIn("tolerance", share)
        by_number, _ = self.run_with(*CORNELL, "--tolerance", "2e-3")
        self.assertEqual(by_number["tolerance"], 2e-3)
        self.write("room.mtl", MTL)
        whole, _ = self.run_with(self.write("room.obj", ROOM), "--subdivision", "none")
        self.assertNotIn("variation_rgb", whole, "no patch has two elements whose light could differ")
        self.assertEqual(whole["tolerance"], 1e-3)

    def test_a_warm_start(self):
        cold, B = self.run_with(*CORNELL, "--tolerance", 1e-4, name="cold")
        start = ("--warm-start", self.work / "cold" / "solution.ply")
        warm, again = self.run_with(*CORNELL, "--tolerance", 1e-4, *start, name="warm", ranks=3)
        self.assertLessEqual(warm["iterations"], 1)
        self.assertLess(cold["iterations"] - warm["iterations"], cold["iterations"])
        self.assertLess(largest_difference(B, again), 4e-4)

    def test_a_warm_start_from_other_elements_is_refused(self):
        self.run_with(*CORNELL, name="cold")
        solution = self.work / "cold" / "solution.ply"
        self.out = self.work / "warm"
        other = (CORNELL[0], "--resolution", "24x24", "--warm-start")
        self.assert_refused(self.solve(*other, solution), "other elements", file=solution)
        self.assert_refused(self.solve(*other, self.work / "none.ply"), file=self.work / "none.ply")
        self.assert_refused(self.solve(*other, CORNELL[0]), file=CORNELL[0], line=1)
        self.assert_refused(self.solve(*other, self.work), file=self.work)

    def test_early_pictures(self):
        # So many elements that one thread shoots for about a second; what has been written must be what is told.
        self.out.mkdir()
        for k in (1, 2, 4, 8):
            (self.out / f"preview-{k}s.png").write_text("of an earlier run")
        job = self.solve(CORNELL[0], "--resolution", "192x192", "--form-factor", "point", "--preview", "--threads", 1,
                         "--no-error-estimate")
        self.assert_done(job)
        told = re.findall(r"preview: ([\d.]+) s, [\d.]+ % of the light is left to shoot: .*/(preview-(\d)s\.png)",
                          job.out)
        self.assertEqual([name for name in self.written() if name.startswith("preview")],
                         sorted(name for _, name, _ in told))
        for seconds, name, after in told:
            self.assertGreaterEqual(float(seconds) + 0.05, float(after))
            self.assertEqual((self.out / name).read_bytes()[:4], b"\x89PNG")
        self.assertTrue(len(told) == 4 or "all light has been shot" in job.out, str(job))
        self.assertGreater(self.report()["time_s"]["preview"], 0)

    def test_early_pictures_do_not_change_the_solution(self):
        _, B = self.run_with(*CORNELL)
        _, after = self.run_with(*CORNELL, "--preview", ranks=2)
        self.assertEqual(B, after)

    def test_early_pictures_need_a_camera(self):
        self.assert_refused(self.solve(CORNELL[0].with_name("cornell-box.obj"), "--preview", "--subdivision", "none"),
                            "--preview", "--eye")

    def test_instruction_sets(self):
        # By Jacobi's method: conjugate gradients, by which coarser meshes are solved too, make more of a last bit, up to the
        # tolerance.
        arguments = (*CORNELL, "--solver", "jacobi", "--tolerance", 3e-4, "--no-error-estimate")
        best, B = self.run_with(*arguments)
        for isa in ("sse4", "avx2", "avx512"):
            with self.subTest(isa):
                job = self.solve(*arguments, "--isa", isa)
                if job.code == 2:
                    self.assertIn("processor", job.said[0])
                    continue
                self.assert_done(job)
                self.assertEqual(self.report()["solve"]["isa"], isa)
                # The sets add up in another order; single precision holds about 1e-7.
                self.assertLess(largest_difference(B, radiosities(self.out / "solution.ply")), 1e-6)
        self.assertIn(best["isa"], ("sse4", "avx2", "avx512"))


if __name__ == "__main__":
    unittest.main()
