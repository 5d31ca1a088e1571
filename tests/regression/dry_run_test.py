"""`--dry-run` with the hierarchical method: two rounds, and a forecast of the others, which a run then is held against."""

import unittest

from fluxel_job import SCENES, JobTest

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
SMALL = (CORNELL, "--resolution", "16x16", "--threads", 1)
MADE = ("block_error", "links", "rows", "nodes", "leaves", "iterations", "change", "discretisation")


class DryRunTest(JobTest):
    method = ()

    def dry(self, *arguments, ranks=2):
        job = self.solve(*arguments, "--dry-run", ranks=ranks)
        self.assert_done(job)
        self.assertEqual(self.written(), ["report.html", "report.json"])
        return job, self.report()

    def test_its_rounds_are_those_of_the_run_and_the_others_are_forecast(self):
        for exchange, target, resolution in (("links", 0.01, "16x16"), ("rays", 0.03, "50x31")):
            with self.subTest(exchange):
                goal = (*SMALL, "--target-error", target, "--exchange", exchange, "--resolution", resolution)
                rounds = []
                for ranks in (1, 2):
                    job, dry = self.dry(*goal, ranks=ranks)
                    rounds.append([[one.get(key) for key in MADE] for one in dry["hierarchy"]["rounds"]])
                said = [line.split(":")[0] for line in job.out.splitlines()]
                self.assertEqual([name for name in said if name in ("round 1", "round 2", "forecast")],
                                 ["round 1", "round 2", "forecast"])
                self.assertEqual(rounds[0], rounds[1])
                self.assertEqual(len(rounds[0]), 2)
                for key in ("solve", "energy", "image", "audit", "stated_error"):
                    self.assertNotIn(key, dry)
                self.assertEqual(dry["elements"], dry["hierarchy"]["rounds"][1]["leaves"])
                self.assertNotIn("reached", dry["hierarchy"])
                self.assertEqual(set(dry["time_s"]), {"load", "subdivision", "forecast", "total"})
                for key in ("bytes_max", "audit_s", "picture_s"):
                    self.assertGreater(dry["forecast"][key], 0, key)

                self.assertIn(self.solve(*goal).code, (0, 3))
                real = self.report()["hierarchy"]
                self.assertEqual([[one.get(key) for key in MADE] for one in real["rounds"][:2]], rounds[0])
                more = dry["forecast"]["rounds"]
                self.assertEqual(more > 0, dry["forecast"]["rounds_s"] > 0)
                self.assertEqual(more > 0, exchange == "links", "by rays two rounds are expected to suffice")
                # The audit may ask for more rounds; the noise of an estimate for fewer or more.
                self.assertLessEqual(abs(len(real["rounds"]) - 2 - more), 3)
                number = min(1 + more, len(real["rounds"]) - 1)
                made, steps = real["rounds"][number], number - 1 - more
                print(f"{exchange}: {dry['forecast']['links']:.3g} forecast, {made['links'] + made['rows']} made")
                if steps == 0:
                    ratio = dry["forecast"]["links"] / (made["links"] + made["rows"])
                    self.assertTrue(1 / 4 < ratio < 4, ratio)
                for file in self.out.iterdir():
                    file.unlink()

    def test_what_two_rounds_suffice_for(self):
        _, dry = self.dry(*SMALL, "--target-error", 0.3)
        self.assertEqual(dry["forecast"]["rounds"], 0)
        self.assertEqual(dry["forecast"]["rounds_s"], 0)
        self.assertEqual(dry["forecast"]["links"], dry["hierarchy"]["rounds"][-1]["links"])

    def test_to_a_block_error_the_rounds_are_known(self):
        # Sixteen times, four times, once.
        job, dry = self.dry(*SMALL, "--block-error", 1e-3)
        self.assertEqual([one["block_error"] for one in dry["hierarchy"]["rounds"]], [1.6e-2, 4e-3])
        self.assertEqual(dry["forecast"]["rounds"], 1)
        self.assertIn("forecast: 1 more round to a block error of 0.001", job.out)

    def test_memory_that_would_not_suffice(self):
        for memory in ("2M", "100K"):  # of the forecast, and of the rounds that are made
            with self.subTest(memory=memory):
                job, _ = self.dry(*SMALL, "--target-error", 0.005, "--memory", memory)
                self.assertEqual(sum("would not fit" in line for line in job.warnings), 1, job)
        job, _ = self.dry(*SMALL, "--target-error", 0.05, "--memory", "1G")
        self.assertEqual(job.warnings, [])

    def test_what_has_no_effect_on_it(self):
        self.out.mkdir()
        (self.out / "preview-9.png").write_bytes(b"earlier")
        job = self.solve(*SMALL, "--target-error", 0.3, "--dry-run", "--time", 1e-3, "--preview", "--checkpoint",
                         self.work / "kept", "--solver", "jacobi", "--audit", 0.2)
        self.assert_done(job)
        for option in ("--time", "--preview", "--checkpoint"):
            self.assertEqual(sum(f"{option} has no effect" in line for line in job.warnings), 1, job)
        for option in ("--solver", "--audit"):
            self.assertFalse(any(f"{option} has no effect" in line for line in job.warnings), job)
        self.assertEqual(len(self.report()["hierarchy"]["rounds"]), 2)
        self.assertFalse((self.work / "kept").exists())
        self.assertEqual(self.written(), ["preview-9.png", "report.html", "report.json"])

    def test_a_wrong_target_is_refused(self):
        self.assert_refused(self.solve(*SMALL, "--target-error", 2, "--dry-run"), "--target-error")


if __name__ == "__main__":
    unittest.main()
