"""Runs that ask for a GPU, on machines with and without one."""

import json
import unittest

from fluxel_job import SCENES, JobTest, start
from result_files import read_exr

CORNELL_FILE = SCENES / "cornell-box" / "cornell-box.toml"
CORNELL = (CORNELL_FILE, "--resolution", "48x48", "--no-error-estimate")


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

    def has_gpu(self):
        """Every rank, as a solve finds it, which the tests above have looked at."""
        return "gpu" in self.visibility("--device", "auto")[1]

    # References: paths of light

    def reference(self, *options):
        return start(["reference", CORNELL_FILE, "--resolution", "24x24", "--rays", 200000, *options, "--out", self.out])

    def measured(self, *options):
        self.assert_done(self.reference(*options))
        return json.loads((self.out / "reference.json").read_text()), (self.out / "reference.exr").read_bytes()

    def test_a_reference_by_auto(self):
        by_processor, picture = self.measured()
        self.assertEqual(by_processor["options"]["device"], "cpu")
        self.assertNotIn("verify_device", by_processor["options"])
        self.assertNotIn("gpu", by_processor)
        found, other = self.measured("--device", "auto", "--verify-device", "0.25")
        self.assertEqual((found["options"]["device"], found["options"]["verify_device"]), ("auto", 0.25))
        self.assertEqual("gpu" in found, self.has_gpu())
        if "gpu" not in found:
            self.assertEqual(other, picture)
            return
        gpu = found["gpu"]
        self.assertEqual(gpu["ranks"], 2)
        self.assertAlmostEqual(gpu["verified_paths"] / gpu["paths"], 0.25, delta=0.02)
        self.assertLessEqual(gpu["differing_paths"], 8 + 1e-3 * gpu["verified_paths"])
        for a, b in zip(found["measured"]["picture"]["mean_rgb"], by_processor["measured"]["picture"]["mean_rgb"]):
            self.assertAlmostEqual(a, b, delta=1e-3 * b)

    def test_a_scene_files_device_is_a_references_too(self):
        scene = CORNELL_FILE.read_text().replace('file = "', f'file = "{CORNELL_FILE.parent}/')
        scene = self.write("cornell.toml", scene.replace("[options]", '[options]\ndevice = "auto"', 1))
        self.assert_done(start(["reference", scene, "--resolution", "8x8", "--rays", 9000, "--out", self.out]))
        self.assertEqual(json.loads((self.out / "reference.json").read_text())["options"]["device"], "auto")

    # Views: first hits

    def view(self, *options):
        return start(["view", CORNELL_FILE, "--solution", self.out / "solution.ply", "--resolution", "24x24",
                      "--target-error", 0.1, *options, "--out", self.work / "seen"])

    def seen(self, *options):
        job = self.view(*options)
        self.assert_done(job)
        return job, json.loads((self.work / "seen" / "report.json").read_text()), read_exr(self.work / "seen" / "image.exr")

    def test_a_view_by_auto(self):
        self.assert_done(self.solve(*CORNELL[:1], "--method", "hierarchical", "--resolution", "24x24", "--target-error", 0.2))
        _, by_processor, picture = self.seen()
        self.assertEqual(by_processor["options"]["device"], "cpu")
        self.assertNotIn("gpu", by_processor)
        job, found, other = self.seen("--device", "auto", "--verify-device", "0.25")
        self.assertEqual((found["options"]["device"], found["options"]["verify_device"]), ("auto", 0.25))
        if "gpu" in found:
            gpu = found["gpu"]
            self.assertAlmostEqual(gpu["verified_rays"] / gpu["rays"], 0.25, delta=0.02)
            self.assertLessEqual(gpu["differing_rays"], 8 + 1e-3 * gpu["verified_rays"])
        else:
            self.assertEqual(job.out.count("2 of 2 ranks work without a GPU: "), 1, str(job))
            self.assertTrue(other == picture)
        job, found, _ = self.seen("--device", "auto", "--picture", "elements", "--audit", 0)
        self.assertTrue(any("--device has no effect" in line for line in job.warnings), job)
        self.assertNotIn("device", found["options"])

    # Both

    def assert_one_message(self, job, *texts):
        """Beside the files of a solve."""
        self.assertEqual((job.code, len(job.said)), (2, 1), str(job))
        for text in texts:
            self.assertIn(text, job.said[0])

    def test_without_a_gpu_cuda_is_refused(self):
        self.assert_done(self.solve(*CORNELL[:1], "--method", "hierarchical", "--resolution", "24x24", "--target-error", 0.2))
        for command in (self.reference, self.view):
            with self.subTest(command.__name__):
                job = command("--device", "cuda")
                if not self.has_gpu():
                    self.assert_one_message(job, "--device cuda: ", "--device auto goes on without")
                self.assert_one_message(command("--device", "gpu"), "--device")
                for share in ("2", "-0.1", "nan", "all"):
                    self.assert_one_message(command("--device", "auto", f"--verify-device={share}"), "--verify-device")
                job = command("--verify-device", "0.5")
                self.assert_done(job)
                self.assertTrue(any("--verify-device has no effect" in line for line in job.warnings), job)


if __name__ == "__main__":
    unittest.main()
