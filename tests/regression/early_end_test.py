"""Runs of the hierarchical method that end before their target: by --time, by a signal; and what they say of it."""

import os
import signal
import time
import unittest

from fluxel_job import OUTPUTS, SCENES, JobTest, finish, launch, lines_until, ranks_of

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
SMALL = (CORNELL, "--resolution", "16x16", "--threads", 1)
# Takes minutes.
ENDLESS = (*SMALL, "--target-error", 0.003)


class EarlyEndTest(JobTest):
    method = ()

    def check_ended(self, job, reason, code):
        """What there is is whole, and its error is said."""
        self.assert_done(job, code=code)
        self.assertEqual([name for name in self.written() if not name.startswith("preview")], sorted(OUTPUTS))
        report = self.report()
        hierarchy = report["hierarchy"]
        self.assertEqual((hierarchy["ended_by"], hierarchy["reached"]), (reason, False))
        self.assertTrue(hierarchy["fits_memory"])
        self.assertGreater(report["stated_error"], report["options"]["target_error"])
        self.assertGreater(report["audit"]["paths"], 0)
        self.assertTrue(any("the error stated is" in line for line in job.warnings), job)
        return hierarchy["rounds"]

    # Time

    def test_time_ends_it(self):
        for ranks in (1, 2):
            for exchange in ("links", "rays"):
                with self.subTest(ranks=ranks, exchange=exchange):
                    job = self.solve(*ENDLESS, "--time", 3, "--exchange", exchange, ranks=ranks)
                    self.check_ended(job, "time", 3)
                    self.assertEqual(sum("--time of 3 s has ended the refinement" in line for line in job.warnings), 1, job)
                    report = self.report()
                    self.assertEqual(report["options"]["time"], 3)
                    self.assertLess(report["time_s"]["total"], 9, "three times as long, however busy the machine is")

    def test_a_time_too_short_for_a_round(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                job = self.solve(*ENDLESS, "--time", 1e-3, ranks=ranks)
                self.assertEqual(len(self.check_ended(job, "time", 3)), 1)
                self.assertTrue(any("within round 1" in line for line in job.warnings), job)

    def test_what_is_not_known_is_not_reached(self):
        # A single round tells of no error, and nothing measures it.
        job = self.solve(*ENDLESS, "--time", 1e-3, "--audit", 0)
        self.assert_done(job, code=3)
        self.assertNotIn("stated_error", self.report())
        self.assertIs(self.report()["hierarchy"]["reached"], False)
        self.assertTrue(any("the error stated is not known" in line for line in job.warnings), job)

    def test_a_time_that_suffices_changes_nothing(self):
        results = []
        for limit in ((), ("--time", 1e6)):
            self.assert_done(self.solve(*SMALL, "--target-error", 0.05, *limit))
            self.assertNotIn("ended_by", self.report()["hierarchy"])
            results.append([(self.out / name).read_bytes() for name in ("image.png", "solution.ply")])
        self.assertTrue(results[0] == results[1])

    def test_another_run_goes_on_with_whole_rounds(self):
        goal = (*SMALL, "--target-error", 0.02, "--checkpoint", self.work / "rounds")
        job = self.solve(*goal, "--time", 1)
        whole = sum(line.startswith("round ") for line in job.out.splitlines())
        self.assert_done(self.solve(*goal, "--resume", ranks=1))
        self.assertEqual(self.report()["hierarchy"]["rounds_resumed"], whole)
        resumed = (self.out / "solution.ply").read_bytes()
        self.assert_done(self.solve(*goal[:-2]))
        self.assertTrue((self.out / "solution.ply").read_bytes() == resumed)

    def test_times_that_are_none(self):
        for value in (0, -1, "nan", "soon"):
            with self.subTest(value=value):
                self.assert_refused(self.solve(*SMALL, "--time", value), "--time")

    # Signals

    def start(self, *arguments, ranks=2):
        """A job whose first round is kept, and said."""
        process = launch(["solve", *arguments, "--checkpoint", self.work / f"kept{ranks}", "--out", self.out], ranks)
        lines_until(process.stdout, "round 1")
        return process

    def test_a_signal_to_any_rank_ends_it(self):
        for ranks, rank, number in ((1, 0, signal.SIGINT), (2, 1, signal.SIGTERM)):
            with self.subTest(ranks=ranks):
                process = self.start(*ENDLESS, ranks=ranks)
                os.kill(ranks_of(process)[rank], number)
                job = finish(process, time.monotonic())
                self.check_ended(job, "signal", 75)
                self.assertEqual(sum("a signal has ended the refinement" in line for line in job.warnings), 1, job)
                self.assertLess(job.seconds, 20)

    def test_usr1_shows_the_round(self):
        for ranks in (1, 2):
            with self.subTest(ranks=ranks):
                process = self.start(*ENDLESS, ranks=ranks)
                os.kill(ranks_of(process)[-1], signal.SIGUSR1)
                told = lines_until(process.stdout, "preview: round ")[-1]
                self.assertRegex(told, r"preview: round \d+, 4 x 4 pixels, its error is (about [\d.]+ %|not known yet): ")
                os.kill(ranks_of(process)[0], signal.SIGTERM)
                job = finish(process, time.monotonic())
                self.check_ended(job, "signal", 75)
                number = told.split()[2].rstrip(",")
                self.assertEqual([name for name in self.written() if name.startswith("preview")], [f"preview-{number}.png"])

    def test_usr1_without_a_camera(self):
        room = SCENES / "cornell-box" / "cornell-box.obj"
        process = self.start(room, "--threads", 1, "--target-error", 0.003)
        process.send_signal(signal.SIGUSR1)
        self.assertIn("has no camera", lines_until(process.stderr, "warning: SIGUSR1")[-1])
        process.send_signal(signal.SIGUSR2)
        self.assertEqual(finish(process, time.monotonic()).code, 75)


if __name__ == "__main__":
    unittest.main()
