"""Runs that ask for a GPU, on machines with and without one."""

import unittest

from fluxel_job import SCENES, JobTest

CORNELL = (SCENES / "cornell-box" / "cornell-box.toml", "--resolution", "48x48", "--no-error-estimate")


class DeviceTest(JobTest):
    def visibility(self, *options):
        self.assert_done(self.solve(*CORNELL, *options))
        report = self.report()
        return report["hash"]["visibility"], report["visibility"]

    def test_auto_gives_the_bits_of_the_processor(self):
        expected, by_processor = self.visibility("--device", "cpu")
        self.assertNotIn("gpu", by_processor)
        found, visibility = self.visibility("--device", "auto", "--verify-device", "0.5")
        self.assertEqual(found, expected)
        if "gpu" not in visibility:
            return
        self.assertEqual(visibility["gpu"]["ranks"], 2)
        self.assertEqual(visibility["gpu"]["differing_bits"], 0)
        self.assertGreater(visibility["gpu"]["verified_pairs"], 1e6)

    def test_auto_says_why_ranks_go_without(self):
        job = self.solve(*CORNELL, "--device", "auto")
        self.assert_done(job)
        if "gpu" in self.report()["visibility"]:
            self.assertEqual(job.out.count("GPUs: "), 1, str(job))
        else:
            self.assertEqual(job.out.count("2 of 2 ranks work without a GPU: "), 1, str(job))

    def test_cuda_without_a_gpu_is_refused(self):
        job = self.solve(*CORNELL, "--device", "cuda")
        if job.code == 0:
            self.assertEqual(self.report()["visibility"]["gpu"]["ranks"], 2)
        else:
            self.assert_refused(job, "--device cuda: ", "--device auto goes on without")

    def test_the_hierarchical_method_knows_no_gpu(self):
        job = self.solve(*CORNELL, "--method", "hierarchical", "--target-error", "0.1", "--device", "cuda")
        self.assert_refused(job, "knows no --no-error-estimate and no --device", "--method matrix")

    def test_shares_that_are_none(self):
        for share in ("-0.1", "1.5", "nan", "all"):
            with self.subTest(share):
                self.assert_refused(self.solve(*CORNELL, f"--verify-device={share}"), "--verify-device")


if __name__ == "__main__":
    unittest.main()
