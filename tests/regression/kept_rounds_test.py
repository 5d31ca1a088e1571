"""Finished rounds of a hierarchy are kept, taken up again by any number of ranks, and change no bit."""

import os
import shutil
import signal
import subprocess
import time
import unittest

from fluxel_job import SCENES, JobTest, finish, launch, lines_until, ranks_of

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
SMALL = (CORNELL, "--resolution", "24x24", "--threads", "1", "--target-error", "0.05")
# The third and last round takes some seconds on two ranks of a fast machine.
SLOW = (CORNELL, "--resolution", "24x24", "--threads", "1", "--block-error", "4e-6")

# The audit after the third round asks for two more.
AUDITED = (CORNELL, "--resolution", "24x24", "--threads", "1", "--target-error", "0.02")


class KeptRoundsTest(JobTest):
    method = ()

    def setUp(self):
        super().setUp()
        self.folder = self.work / "rounds"

    def keep(self, *arguments, ranks=2, **settings):
        return self.solve(*arguments, "--checkpoint", self.folder, ranks=ranks, **settings)

    def kept(self, pattern="*"):
        return sorted(self.folder.glob(pattern))

    def results(self):
        """What has to be the same, byte by byte."""
        return [(self.out / name).read_bytes() for name in ("solution.ply", "image.png")]

    def undisturbed(self, *arguments):
        self.assert_done(self.solve(*arguments, ranks=1))
        return self.results(), self.report()["hierarchy"]

    def check_resumed(self, undisturbed, resumed, *arguments, ranks=2):
        results, totals = undisturbed
        job = self.keep(*arguments, "--resume", ranks=ranks)
        self.assert_done(job)
        found = self.report()["hierarchy"]
        self.assertEqual(found["rounds_resumed"], resumed)
        self.assertEqual(self.report()["solve"]["tolerance"], found["chosen"]["tolerance"])
        for name in ("errors", "chosen", "reached", "node_pairs_looked_at", "shafts", "contours", "rays"):
            self.assertEqual(found.get(name), totals.get(name), name)
        for name in ("block_error", "links", "nodes", "leaves", "iterations", "change", "discretisation"):
            self.assertEqual([r.get(name) for r in found["rounds"]], [r.get(name) for r in totals["rounds"]], name)
        self.assertTrue(self.results() == results, "solution.ply or image.png differs")
        return job

    def start_third_round(self, ranks):
        process = launch(["solve", *SLOW, "--out", self.out, "--checkpoint", self.folder], ranks)
        lines_until(process.stdout, "round 2")
        self.wait_for_work(process, 0.3)
        return process

    def end(self, process):
        return finish(process, time.monotonic())

    def test_usr2_stops_and_another_number_of_ranks_goes_on(self):
        undisturbed = self.undisturbed(*SLOW)
        shutil.rmtree(self.out)
        process = self.start_third_round(ranks=2)
        os.kill(ranks_of(process)[1], signal.SIGUSR2)  # one rank alone
        job = self.end(process)
        self.assertEqual(job.code, 75, str(job))
        self.assertLess(job.seconds, 10)
        self.assertEqual(len(job.said), 1, str(job))
        self.assertIn("go on with --resume", job.said[0])
        self.assertEqual(job.err.count("refinement: done"), 2, "the third has to be broken off")
        self.assertNotIn("solution.ply", self.written())
        self.assertEqual(len(self.kept()), 3)
        self.check_resumed(undisturbed, 2, *SLOW, ranks=3)

    def test_audits_go_on_with_paths_that_were_kept(self):
        undisturbed = self.undisturbed(*AUDITED)
        audit = self.report()["audit"]
        process = launch(["solve", *AUDITED, "--out", self.out, "--checkpoint", self.folder], 2)
        lines_until(process.stdout, "round 4")
        os.kill(ranks_of(process)[0], signal.SIGKILL)
        self.end(process)
        self.check_resumed(undisturbed, 4, *AUDITED)
        for name in ("paths", "error", "scale_of_reflected"):
            self.assertEqual(self.report()["audit"][name], audit[name], name)

    def test_a_killed_rank_loses_one_round(self):
        undisturbed = self.undisturbed(*SLOW)
        process = self.start_third_round(ranks=3)
        os.kill(ranks_of(process)[0], signal.SIGKILL)
        self.assertNotIn(self.end(process).code, (0, None))
        self.check_resumed(undisturbed, 2, *SLOW, ranks=1)

    def test_usr1_goes_on(self):
        process = self.start_third_round(ranks=2)
        process.send_signal(signal.SIGUSR1)
        job = self.end(process)
        self.assert_done(job)
        self.assertEqual(job.warnings, [])

    def test_a_finished_run_is_taken_up_by_any_number_of_ranks(self):
        undisturbed = self.undisturbed(*SMALL)
        self.assert_done(self.keep(*SMALL, ranks=3))
        rounds = len(undisturbed[1]["rounds"])
        self.assertGreater(rounds, 2)
        counts = self.report()["checkpoint"]
        self.assertEqual((counts["files"], counts["writes"]), (4, 4 * rounds))
        self.assertEqual(counts["bytes"], sum(file.stat().st_size for file in self.kept()))
        self.assertEqual(len(self.kept()), 4)
        for ranks in (1, 2, 7):
            with self.subTest(ranks=ranks):
                job = self.check_resumed(undisturbed, rounds, *SMALL, ranks=ranks)
                self.assertEqual(job.warnings, [])

    def test_what_is_damaged_is_named_and_begun_anew(self):
        undisturbed = self.undisturbed(*SMALL)

        def flip(file):
            data = bytearray(file.read_bytes())
            data[len(data) // 2] ^= 4
            file.write_bytes(data)

        def cut(file):
            file.write_bytes(file.read_bytes()[:-10])

        for damage, pattern, reason in ((flip, "links-*-1-of-2*", "is damaged or cut off"),
                                        (cut, "links-*-0-of-2*", "is damaged or cut off"),
                                        (os.remove, "links-*-1-of-2*", "is missing"),
                                        (flip, "rounds-*", "is damaged or cut off"),
                                        (cut, "rounds-*", "is damaged or cut off")):
            with self.subTest(damage=damage.__name__, pattern=pattern):
                shutil.rmtree(self.folder, ignore_errors=True)
                self.assert_done(self.keep(*SMALL))
                file, = self.kept(pattern)
                damage(file)
                job = self.check_resumed(undisturbed, 0, *SMALL, ranks=3)
                self.assertEqual(len(job.warnings), 1, str(job))
                self.assertIn(f"{file} {reason}", job.warnings[0])
                self.assertEqual(len(self.kept()), 4)

    def test_an_empty_file_of_rounds_is_named(self):
        undisturbed = self.undisturbed(*SMALL)
        self.assert_done(self.keep(*SMALL))
        file, = self.kept("rounds-*")
        file.write_bytes(b"")
        job = self.check_resumed(undisturbed, 0, *SMALL)
        self.assertEqual(len(job.warnings), 1, str(job))
        self.assertIn(f"{file} is too short to be a file of rounds", job.warnings[0])

    def test_rounds_that_cannot_be_read_are_left_as_they_are(self):
        self.assert_done(self.keep(*SMALL))
        file, = self.kept("rounds-*")
        file.unlink()
        file.mkdir()  # which root cannot read as a file either
        before = self.kept()
        job = self.keep(*SMALL, "--resume", ranks=3)
        self.assertEqual(job.code, 2, str(job))
        self.assertEqual(len(job.said), 1, str(job))
        for text in (str(file), "cannot be read", "directory", "--checkpoint"):
            self.assertIn(text, job.said[0])
        self.assertEqual(self.kept(), before)

    def test_rounds_of_other_options_are_named_and_left(self):
        self.assert_done(self.keep(*SMALL))
        before = [(file, file.read_bytes()) for file in self.kept()]
        job = self.keep(*SMALL[:-1], "0.06", "--resume")
        self.assert_done(job)
        self.assertEqual(self.report()["hierarchy"]["rounds_resumed"], 0)
        self.assertIn("other options", "\n".join(job.warnings))
        self.assertEqual([(file, file.read_bytes()) for file, _ in before], before)

    def test_rounds_are_not_written_over_unasked(self):
        self.assert_done(self.keep(*SMALL))
        job = self.keep(*SMALL)
        self.assertEqual(job.code, 2, str(job))
        self.assertIn("--resume", job.said[0])
        self.assertIn(str(self.folder), job.said[0])

    def test_what_is_of_the_matrix_alone(self):
        for option in (("--visibility-only",), ("--reuse-visibility", self.work)):
            job = self.keep(*SMALL, *option)
            self.assertEqual(job.code, 2, str(job))
            self.assertIn(option[0], job.said[0])

    def test_no_clock_keeps_rounds(self):
        job = self.keep(*SMALL, "--checkpoint-every", 1)
        self.assertEqual(job.code, 2, str(job))
        self.assertIn("knows no --checkpoint-every", job.said[0])

    def test_a_full_disk_is_told_and_survived(self):
        undisturbed = self.undisturbed(*SMALL)
        self.folder.mkdir()
        mount = ["mount", "-t", "tmpfs", "-o", "size=32k", "tmpfs", self.folder]
        if os.geteuid() != 0 or subprocess.run(mount, capture_output=True, check=False).returncode != 0:
            self.skipTest("a small disk cannot be mounted here")
        self.addCleanup(subprocess.run, ["umount", "-l", self.folder], check=False)
        job = self.keep(*SMALL)
        self.assert_done(job)
        self.assertIn("No space left", "\n".join(job.warnings))
        self.assertIn("the round is not kept, and the run goes on", "\n".join(job.warnings))
        # What stands there is a round before.
        self.assertEqual(len(self.kept()), 3)
        self.check_resumed(undisturbed, self.report()["checkpoint"]["writes"] // 3, *SMALL, ranks=3)


if __name__ == "__main__":
    unittest.main()
