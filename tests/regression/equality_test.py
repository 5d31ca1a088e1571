"""What is promised to be equal for every number of ranks and threads."""

import unittest

from fluxel_job import SCENES, JobTest
from result_files import radiosities
from rooms import MTL, VERTICES

CORNELL = (SCENES / "cornell-box" / "cornell-box.toml", "--resolution", "24x24")
WOOD = (SCENES / "construction-in-wood" / "construction-in-wood.toml", "--resolution", "16x16", "--sides", "two",
        "--max-edge", "0.8")

RANKS_AND_THREADS = [(ranks, threads) for ranks in (1, 2, 3, 4, 7) for threads in (1, 2)][1:]


class EqualityTest(JobTest):
    def run_on(self, ranks, threads, *arguments):
        self.out = self.work / f"out-{ranks}-{threads}"
        self.assert_done(self.solve(*arguments, "--threads", threads, "--quiet", ranks=ranks))
        return self.report()

    def check_equal(self, *arguments, runs=RANKS_AND_THREADS):
        """All runs against one rank with one thread; its report."""
        first = self.run_on(1, 1, *arguments)
        solution = (self.out / "solution.ply").read_bytes()
        for ranks, threads in runs:
            with self.subTest(ranks=ranks, threads=threads):
                report = self.run_on(ranks, threads, *arguments)
                self.assertEqual((report["ranks"], report["threads"]), (ranks, threads))
                self.assertEqual(report["hash"], first["hash"])
                self.assertEqual(report["solve"]["iterations"], first["solve"]["iterations"])
                self.assertEqual(report["error_estimate"], first["error_estimate"])
                self.assertTrue((self.out / "solution.ply").read_bytes() == solution, "solution.ply differs")
        return first

    def test_one_sided(self):
        report = self.check_equal(*CORNELL)
        self.assertEqual(len(report["error_estimate"]["elements"]), 3)
        self.assertEqual(report["unknowns"], report["elements"])

    def test_two_sided(self):
        report = self.check_equal(*WOOD)
        self.assertGreater(min(report["error_estimate"]["discretisation_rgb"]), 0)
        self.assertGreater(report["unknowns"], report["elements"])
        self.assertGreater(report["elements"], 7 * 64, "a row of tiles for every rank")

    def test_every_solver(self):
        for solver in ("jacobi", "southwell"):
            with self.subTest(solver):
                self.check_equal(*CORNELL, "--solver", solver, runs=[(2, 2), (3, 1)])

    def test_every_instruction_set(self):
        for isa in ("sse4", "avx2"):
            with self.subTest(isa):
                self.check_equal(*WOOD, "--isa", isa, runs=[(2, 2), (3, 1)])

    def test_shortcuts_change_no_bit(self):
        for scene in (CORNELL, WOOD):
            with self.subTest(scene=scene[0].name):
                quick = self.run_on(1, 1, *scene)
                slow = self.run_on(3, 2, *scene, "--trace-every-pair")
                self.assertEqual(slow["hash"], quick["hash"])
                self.assertGreater(slow["visibility"]["rays"], 1.5 * quick["visibility"]["rays"])

    def test_more_ranks_than_patches(self):
        self.write("two.mtl", MTL)
        faces = "usemtl white\nf 1 2 3 4\nusemtl light\nf 5 8 7 6\n"
        scene = self.write("two.obj", "mtllib two.mtl\n" + VERTICES + faces)
        report = self.check_equal(scene, "--sides", "one", "--subdivision", "none", runs=[(3, 1), (7, 2)])
        self.assertEqual((report["patches"], report["elements"]), (2, 2))
        self.assertEqual(report["error_estimate"]["elements"], [2])

    def test_gauss_seidel_agrees_within_the_tolerance(self):
        # Each run is within the tolerance, relative to the area-mean of B, of the exact solution. The mean over the
        # elements, which are smaller where the camera looks, has that size and is all that the file tells.
        tolerance = 1e-4
        arguments = (*CORNELL, "--solver", "gauss-seidel", "--tolerance", tolerance)
        self.run_on(1, 1, *arguments)
        alone = radiosities(self.out / "solution.ply")
        mean = [sum(face[channel] for face in alone) / len(alone) for channel in range(3)]
        for ranks in (2, 7):
            with self.subTest(ranks=ranks):
                self.assertTrue(self.run_on(ranks, 1, *arguments)["solve"]["converged"])
                among = radiosities(self.out / "solution.ply")
                worst = max(abs(a[c] - b[c]) / mean[c] for a, b in zip(alone, among) for c in range(3))
                self.assertLess(worst, 4 * tolerance)

    def test_the_same_twice(self):
        self.run_on(2, 2, *CORNELL)
        solution = (self.out / "solution.ply").read_bytes()
        self.run_on(2, 2, *CORNELL)
        self.assertTrue((self.out / "solution.ply").read_bytes() == solution)


if __name__ == "__main__":
    unittest.main()
