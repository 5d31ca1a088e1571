"""What a run that comes to its end leaves: exit code, report, solution, forecast."""

import math
import os
import struct
import subprocess
import unittest

from fluxel_job import OUTPUTS, SCENES, JobTest, solution_header, start
from report_schema import check_reports
from rooms import INSIDE, MTL, ROOM, SMALL, VERTICES, scene_file

import fluxel

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"

# What a reader of report.json may rely on.
REPORT_KEYS = {
    "": ("patches", "elements", "unknowns", "ranks", "threads", "options", "version"),
    "time_s": ("load", "subdivision", "visibility", "solve", "image", "estimate", "total"),
    "visibility": ("pairs", "rays", "bytes", "tiles_uniform", "tiles_mixed"),
    "form_factor": ("row_sum_max", "closure_defect_rms"),
    "solve": ("solver", "iterations", "residual", "error_bound", "converged"),
    "energy": ("emitted", "absorbed", "escaped", "defect"),
    "error_estimate": ("discretisation_rgb", "convergence_rgb", "elements", "order"),
    "memory": ("predicted_bytes_max", "peak_rss_bytes_max"),
    "hash": ("elements", "visibility"),
}
FRONT = [f"property float radiosity_{channel}" for channel in "rgb"]
BACK = [f"property float radiosity_back_{channel}" for channel in "rgb"]


DESK = '[[receivers]]\nname = "desk"\norigin = [0.2, 0.2, 0.2]\nu = [0.5, 0, 0]\nv = [0, 0.5, 0]\ncells = [4, 4]\n'


class OutcomeTest(JobTest):
    def setUp(self):
        super().setUp()
        self.write("room.mtl", MTL)
        self.room = self.write("room.obj", ROOM)

    # Report and solution

    def test_every_file_says_what_was_not_reached(self):
        scene = self.write("room.toml", scene_file(DESK))
        told = {}
        for reached, iterations in ((True, 100), (False, 1)):
            job = self.solve(scene, "--write", "vtu,glb,lightmap,false-colour,ply-triangles", "--lightmap-texel", 0.1, "--subdivision",
                             "uniform", "--max-edge", 0.25, "--max-iterations", iterations, "--no-error-estimate", "--audit", 0)
            self.assertEqual(job.code, 0 if reached else 3, job)
            headers = [(self.out / name).read_bytes()[:2000] for name in ("solution.ply", "solution-triangles.ply", "solution.vtu")]
            attributes = [fluxel.read_picture(self.out / name).attributes for name in ("image.exr", "lightmap.exr")]
            assets = [fluxel.GlbFile(self.out / name).model["asset"] for name in ("solution.glb", "lightmap.glb")]
            for says in (*(b"the solver has not converged" in header for header in headers),
                         *(of.get("fluxel.unreached") == "the solver has not converged" for of in attributes),
                         *(of.get("extras") == {"comment": "the solver has not converged"} for of in assets)):
                self.assertEqual(says, not reached)
            # Whatever the solution is, receivers have been measured.
            self.assertEqual(set(fluxel.read_table(self.out / "receivers.csv")["reached"]), {True})
            self.assertEqual(fluxel.read_grid(self.out / "solution.vtu").field_data["reached"], reached)
            fluxel.read_elements(self.out / "solution.ply")
            told[reached] = [(self.out / name).read_bytes() for name in ("image-false-colour.png",)]
        # One line of text more.
        for with_line, without in zip(told[False], told[True], strict=True):
            self.assertGreater(struct.unpack_from(">I", with_line, 20), struct.unpack_from(">I", without, 20))
        # Nobody asks for an error of the receivers themselves: a run that ends with 0 has reached all.
        self.assert_done(self.solve(self.write("noisy.toml", scene_file(DESK.replace("[4, 4]", "[400, 400]"))), "--subdivision",
                                    "uniform", "--max-edge", 0.25, "--no-error-estimate", "--audit", 0))
        self.assertEqual(set(fluxel.read_table(self.out / "receivers.csv")["reached"]), {True})
        # The light is read again, with the comment in the header.
        self.assert_done(start(["view", scene, *INSIDE, *SMALL, "--solution", self.out / "solution.ply", "--out", self.work / "seen",
                                "--target-error", 0.5, "--quiet"], ranks=1))

    def test_report_has_every_key(self):
        self.assert_done(self.solve(CORNELL, "--resolution", "32x32", "--threads", "1", ranks=3))
        report = self.report()
        for group, keys in REPORT_KEYS.items():
            for key in keys:
                self.assertIn(key, report[group] if group else report, group)
        self.assertEqual((report["ranks"], report["threads"]), (3, 1))
        self.assertEqual(report["patches"], 21)
        elements = report["elements"]
        self.assertEqual(report["unknowns"], elements, "one side each")
        self.assertEqual(report["visibility"]["pairs"], elements * (elements - 1) // 2)
        tiles = (elements + 63) // 64
        self.assertEqual(report["visibility"]["tiles_uniform"] + report["visibility"]["tiles_mixed"],
                         tiles * (tiles + 1) // 2)
        self.assertAlmostEqual(report["forecast"]["tiles_mixed_fraction"],
                               report["visibility"]["tiles_mixed"] / (tiles * (tiles + 1) // 2), delta=1e-12,
                               msg="so few tiles are not guessed at")
        times = report["time_s"]
        phases = sum(seconds for name, seconds in times.items() if name != "total")
        self.assertLessEqual(phases, 1.001 * times["total"] + 0.001)
        self.assertGreater(phases, 0.5 * times["total"], "each phase is timed")
        self.assertTrue(report["solve"]["converged"])
        # pi * (17, 12, 4) W/m2 from 0.01365 m2.
        for emitted, expected in zip(report["energy"]["emitted"], (0.72901, 0.51459, 0.17153)):
            self.assertAlmostEqual(emitted, expected, delta=1e-4)
        self.check_solution(elements, FRONT)

    def test_two_sided_solution_has_backs(self):
        obj = ROOM.replace("f 2 6 7 3\n", "")  # open, so that no side is sealed off
        self.assert_done(self.solve(self.write("open.obj", obj), *INSIDE, *SMALL, "--sides", "two"))
        report = self.report()
        self.assertEqual(report["unknowns"], 2 * report["elements"])
        self.check_solution(report["elements"], FRONT + BACK)

    def test_sealed_sides_are_no_unknowns(self):
        box = "".join(f"v {x} {y} {z}\n" for z in (0.4, 0.6)
                      for x, y in ((0.4, 0.4), (0.6, 0.4), (0.6, 0.6), (0.4, 0.6)))
        outward = "".join(f"f {face}\n" for face in ("12 11 10 9", "10 14 13 9", "11 15 14 10", "12 16 15 11",
                                                     "9 13 16 12", "14 15 16 13"))
        obj = ROOM + "usemtl white\n" + box + outward
        self.assert_done(self.solve(self.write("boxed.obj", obj), *INSIDE, *SMALL, "--sides", "two"))
        report = self.report()
        self.assertEqual(report["scene"]["sealed_sides"], 6)
        self.assertLess(report["unknowns"], 2 * report["elements"])
        self.check_solution(report["elements"], FRONT + BACK)

    def check_solution(self, elements, radiosities):
        header = solution_header(self.out / "solution.ply")
        self.assertEqual(header[:2], ["ply", "format binary_little_endian 1.0"])
        self.assertIn(f"element face {elements}", header)
        self.assertEqual([line for line in header if "property float radiosity" in line], radiosities)
        self.assertIn("property uint patch", header)

    def test_lights_that_face_away_are_said(self):
        away = ROOM.replace("f 5 8 7 6", "f 5 6 7 8")
        floor_alone = "\n".join(line for line in ROOM.splitlines() if not line.startswith("f") or line in ("f 1 2 3 4", "f 5 8 7 6"))
        for name, obj, warns in (("right", ROOM, False), ("away", away, True), ("four fifths escape", floor_alone, False)):
            for method in ("hierarchical", "matrix"):
                with self.subTest(scene=name, method=method):
                    job = self.solve(self.write("lamp.obj", obj), "--sides", "one", "--method", method,
                                     *(["--subdivision", "uniform", "--max-edge", 0.25] if method == "matrix" else []))
                    self.assert_done(job)
                    self.assertEqual(any("face away" in line for line in job.warnings), warns, job)

    # Runs that do not converge

    def assert_not_converged(self, job, *causes):
        self.assert_done(job, code=3)
        self.assertEqual(self.written(), sorted(OUTPUTS))
        solve = self.report()["solve"]
        self.assertFalse(solve["converged"])
        warnings = [line for line in job.warnings if "not converged" in line]
        self.assertEqual(len(warnings), 1, str(job))
        for cause in causes:
            self.assertIn(cause, warnings[0])
            self.assertIn(cause, solve["cause"])
        self.assertLess(job.seconds, 10)

    def test_too_few_iterations(self):
        for solver in ("jacobi", "gauss-seidel"):
            with self.subTest(solver):
                job = self.solve(self.room, *INSIDE, *SMALL, "--max-iterations", "1", "--solver", solver)
                self.assert_not_converged(job, "--max-iterations")
                self.assertEqual(self.report()["solve"]["iterations"], 1)

    def test_quiet_still_warns(self):
        job = self.solve(self.room, *INSIDE, *SMALL, "--max-iterations", "1", "--quiet")
        self.assert_not_converged(job)
        self.assertEqual(job.out, "")

    def test_divergence_of_the_point_rule(self):
        # Six elements of 1 m2, each 0.707 m from four others: cos * cos / (pi r^2) = 0.32 towards each of these and
        # 0.32 opposite, row sums of 1.6; with rho = 0.95 every iteration grows.
        self.write("room.mtl", MTL.replace("0.5 0.5 0.5", "0.95 0.95 0.95").replace("0.2 0.2 0.2", "0.95 0.95 0.95"))
        job = self.solve(self.room, *INSIDE, *SMALL, "--sides", "one", "--subdivision", "none",
                         "--form-factor", "point")
        self.assert_not_converged(job, "diverge", "--form-factor adaptive")
        report = self.report()
        self.assertGreater(report["form_factor"]["row_sum_max"], 1.5)
        self.assertTrue(any("row sum" in line for line in job.warnings), str(job))

    def test_a_tolerance_below_single_precision(self):
        for solver in ("jacobi", "gauss-seidel", "cg", "southwell"):
            with self.subTest(solver):
                job = self.solve(self.room, *INSIDE, *SMALL, "--tolerance", "1e-12", "--solver", solver)
                self.assert_not_converged(job, "single precision")
                self.assertGreater(self.report()["solve"]["error_bound"], 1e-7)

    def test_a_solution_that_is_not_finite(self):
        # Plates that are 5 micrometres apart, by the point rule: their form factors are 10^10.
        self.assert_done(self.solve(self.room, *INSIDE, *SMALL))  # whose files must not stay
        plate = "f 1 2 3 4\nusemtl light\nf 8 7 6 5\n"
        obj = "mtllib plates.mtl\nusemtl white\n" + VERTICES.replace(" 1\n", " 5e-6\n") + plate
        self.write("plates.mtl", "newmtl white\nKd 1 1 1\nnewmtl light\nKd 1 1 1\nKe 1e15 1e15 1e15\n")
        job = self.solve(self.write("plates.obj", obj), "--subdivision", "none", "--sides", "one", "--form-factor",
                         "point")
        self.assert_done(job, code=3)
        self.assertEqual(self.written(), ["convergence.csv", "report.html", "report.json"])
        self.assertEqual(sum("neither picture nor solution" in line for line in job.warnings), 1, str(job))
        for lie in ("solution:", "picture:", "nan"):
            self.assertNotIn(lie, job.out)
        # Whether the balance is beyond all numbers or only beyond all reason, it is not said to close.
        self.assertGreater(self.report()["energy"].get("defect_relative", math.inf), 0.5)

    # Light that goes nowhere

    def test_a_large_defect_is_told(self):
        # A light 0.15 m above a plate in a scene of 100 km: about what rays in single precision take as one plane
        # there, so that three tenths of the light are lost.
        obj = ("mtllib room.mtl\n" + VERTICES.replace(" 1\n", " 0.15\n") + "v 1e5 0 0\nv 1e5 1 0\nv 1e5 0 1\n" +
               "usemtl white\nf 1 2 3 4\nf 9 10 11\nusemtl light\nf 5 8 7 6\n")
        scene = self.write("gap.obj", obj)
        job = self.solve(scene, "--subdivision", "none", "--sides", "one")
        self.assert_done(job)
        self.assertGreater(self.report()["energy"]["defect_relative"], 0.25)
        self.assertEqual(sum("unaccounted for" in line for line in job.warnings), 1, str(job))
        warnings = "\n".join(self.report()["warnings"])
        self.assertIn("unaccounted for", warnings)
        self.assertIn("paths of light find the whole", warnings)

    def test_a_small_defect_is_not(self):
        job = self.solve(self.room, "--subdivision", "none", "--sides", "one")
        self.assert_done(job)
        self.assertEqual(job.warnings, [])

    # Times

    def test_reading_is_part_of_the_load(self):
        # Points that no face has are only read: what they add to a run belongs to its load.
        self.assert_done(self.solve(self.room, "--subdivision", "none", "--dry-run", ranks=1))
        short = self.report()["time_s"]
        scene = self.write("long.obj", ROOM + "v 0.123456 0.234567 0.345678\n" * 1_000_000)
        job = self.solve(scene, "--subdivision", "none", "--dry-run", ranks=1)
        self.assert_done(job)
        long = self.report()["time_s"]
        for name in ("load", "total"):
            self.assertGreater(long[name] - short[name], 0.1, job)
        self.assertLess(long["total"], job.seconds)

    # Dry runs

    def test_dry_run_predicts_and_stops(self):
        arguments = (CORNELL, "--resolution", "64x64", "--threads", "1")
        self.assert_done(self.solve(*arguments, "--dry-run"))
        self.assertEqual(self.written(), ["report.html", "report.json"])
        predicted = self.report()
        self.assertGreater(predicted["elements"], 64 * 64 / 2)
        self.assertGreater(predicted["unknowns"], 0)
        self.assertGreater(predicted["forecast"]["visibility_s"], 0)
        self.assertEqual(predicted["visibility"]["pairs"], predicted["elements"] * (predicted["elements"] - 1) // 2)
        self.assertNotIn("solve", predicted)
        self.assertNotIn("closed", predicted["scene"], "that is known after the rays of the energy balance")

        self.assert_done(self.solve(*arguments))
        real = self.report()
        self.assertEqual(real["elements"], predicted["elements"])
        self.assertEqual(real["unknowns"], predicted["unknowns"])
        self.assertEqual(real["hash"]["elements"], predicted["hash"]["elements"])
        self.assertEqual(real["visibility"]["pairs"], predicted["visibility"]["pairs"])

    def test_predicted_memory(self):
        # Less what a run of two elements needs, the libraries and files of any job.
        self.assert_done(self.solve(self.room, "--subdivision", "none", "--threads", "1", "--form-factor", "disc"))
        least = self.report()["memory"]
        self.assert_done(self.solve(CORNELL, "--resolution", "96x96", "--threads", "1", "--form-factor", "disc"))
        memory = self.report()["memory"]
        predicted, real = (memory[key] - least[key] for key in ("predicted_bytes_max", "peak_rss_bytes_max"))
        ratio = predicted / real
        print(f"predicted over real memory: {ratio:.2f}")
        self.assertGreater(ratio, 0.7)
        self.assertLess(ratio, 1.5)

    def test_peak_of_memory_is_of_the_run_alone(self):
        # A process's own count of its peak begins with that of what started it.
        held = b"x" * (1 << 29)
        run = subprocess.run([os.environ["FLUXEL"], "solve", *self.method, self.room, "--subdivision", "none", "--quiet", "--out", self.out])
        self.assertEqual(run.returncode, 0)
        check_reports(self.out)
        self.assertLess(self.report()["memory"]["peak_rss_bytes_max"], len(held) / 2)


if __name__ == "__main__":
    unittest.main()
