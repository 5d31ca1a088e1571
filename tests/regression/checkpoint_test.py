"""Finished strips of visibility are kept, taken up again by any number of ranks, and change no bit."""

import os
import shutil
import signal
import subprocess
import time
import unittest

from fluxel_job import MATRIX, SCENES, JobTest, finish, launch, lines_until, ranks_of

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
SMALL = (CORNELL, "--resolution", "32x32", "--threads", "1")
# Seconds of visibility on two ranks of a fast machine, and little else.
SLOW = (CORNELL, "--resolution", "112x112", "--threads", "1", "--trace-every-pair", "--form-factor", "disc",
        "--tolerance", "0.1", "--no-error-estimate")


class CheckpointTest(JobTest):
    def setUp(self):
        super().setUp()
        self.folder = self.work / "strips"

    def keep(self, *arguments, ranks=2, **settings):
        return self.solve(*arguments, "--checkpoint", self.folder, ranks=ranks, **settings)

    def resume(self, *arguments, ranks=2):
        job = self.keep(*arguments, "--resume", ranks=ranks)
        self.assert_done(job)
        return job, self.report()

    def strips(self):
        return sorted(self.folder.glob("strips-*.fxs"))

    def undisturbed(self, *arguments):
        """The report of a run that keeps nothing."""
        self.assert_done(self.solve(*arguments, ranks=2))
        return self.report()

    def check_resumed(self, report, undisturbed, least=1):
        """The same bits, some of them from before."""
        self.assertEqual(report["hash"], undisturbed["hash"])
        self.assertGreaterEqual(report["visibility"]["tiles_resumed"], least)
        counts = [undisturbed["visibility"][name] for name in ("tiles_uniform", "tiles_mixed")]
        self.assertEqual([report["visibility"][name] for name in ("tiles_uniform", "tiles_mixed")], counts)
        self.assertEqual(report["visibility"]["tiles_resumed"] + report["visibility"]["tiles_computed"], sum(counts))

    def start_slow(self, *arguments, ranks=2):
        """A job in its visibility phase."""
        process = launch(["solve", *MATRIX, *SLOW, "--out", self.out, *arguments], ranks)
        lines_until(process.stdout, "forecast")
        self.wait_for_work(process, 0.3)
        return process

    def start_keeping(self, every, ranks=2):
        return self.start_slow("--checkpoint", self.folder, "--checkpoint-every", every, ranks=ranks)

    def end(self, process):
        return finish(process, time.monotonic())

    def test_another_number_of_ranks_goes_on(self):
        undisturbed = self.undisturbed(*SMALL)
        self.assert_done(self.keep(*SMALL, "--visibility-only", ranks=3))
        self.assertEqual(self.report()["hash"], undisturbed["hash"])
        self.assertEqual(self.report()["checkpoint"]["files"], 3)
        self.assertEqual(self.report()["checkpoint"]["bytes"], sum(file.stat().st_size for file in self.strips()))
        # A file is missing, and another stands there twice, as after a kill while the files of a former job are replaced.
        self.strips()[1].unlink()
        shutil.copy(self.strips()[0], str(self.strips()[0]).replace("0-of-3", "0-of-5"))
        for ranks in (2, 7):
            with self.subTest(ranks=ranks):
                _, report = self.resume(*SMALL, ranks=ranks)
                self.check_resumed(report, undisturbed)
                self.assertEqual(report["visibility"]["tiles_computed"] > 0, ranks == 2)
                self.assertEqual(report["warnings"], [])
                names = [file.name.split("-", 2)[2] for file in self.strips()]
                self.assertEqual(names, [f"{rank}-of-{ranks}.fxs" for rank in range(ranks)])

    def test_damaged_cut_and_foreign_files_are_named(self):
        undisturbed = self.undisturbed(*SMALL)
        self.assert_done(self.keep(*SMALL, "--visibility-only", ranks=4))
        damaged, cut, foreign, _ = self.strips()
        other = self.work / "other"
        self.assert_done(self.solve(CORNELL, "--resolution", "16x16", "--checkpoint", other, "--visibility-only"))
        data = bytearray(damaged.read_bytes())
        data[len(data) // 2] ^= 4
        damaged.write_bytes(data)
        cut.write_bytes(cut.read_bytes()[:-100])
        shutil.copy(sorted(other.iterdir())[0], foreign)
        job, report = self.resume(*SMALL, ranks=2)
        self.check_resumed(report, undisturbed)
        self.assertGreater(report["visibility"]["tiles_computed"], 0)
        for file, reason in ((damaged, "is damaged or cut off"), (cut, "is damaged or cut off"),
                             (foreign, "is of another scene")):
            self.assertEqual(sum(f"{file} {reason}" in line for line in job.warnings), 1, str(job))
            self.assertEqual(sum(f"{file} {reason}" in line for line in report["warnings"]), 1)

    def test_strips_of_another_scene_are_named_and_left(self):
        self.assert_done(self.keep(CORNELL, "--resolution", "16x16", "--visibility-only"))
        before = self.strips()
        job, report = self.resume(*SMALL)
        self.assertEqual(report["visibility"]["tiles_resumed"], 0)
        self.assertIn("of another scene", "\n".join(job.warnings))
        self.assertTrue(set(before) < set(self.strips()))

    def test_usr1_keeps_and_goes_on(self):
        process = self.start_keeping(1000)
        self.assertEqual(self.strips(), [])
        process.send_signal(signal.SIGUSR1)
        self.wait_for(lambda: len(self.strips()) == 2, process)
        self.assert_done(self.end(process))
        self.assertEqual(self.report()["checkpoint"]["writes"], 4)

    def test_the_clock_keeps(self):
        process = self.start_keeping(0.2)
        self.wait_for(lambda: len(self.strips()) == 2, process)
        self.assert_done(self.end(process))
        self.assertGreater(self.report()["checkpoint"]["writes"], 4)

    def test_never_by_the_clock(self):
        self.assert_done(self.keep(*SMALL, "--checkpoint-every", "1e10"))
        self.assertEqual(self.report()["checkpoint"]["writes"], 2)

    def test_usr2_keeps_and_stops(self):
        undisturbed = self.undisturbed(*SLOW)
        process = self.start_keeping(1000, ranks=3)
        process.send_signal(signal.SIGUSR2)
        job = self.end(process)
        self.assertEqual(job.code, 75, str(job))
        self.assertLess(job.seconds, 10)
        self.assertEqual(len(job.said), 1, str(job))
        self.assertIn("go on with --resume", job.said[0])
        self.assertEqual(len(self.strips()), 3)
        _, report = self.resume(*SLOW, ranks=2)
        self.check_resumed(report, undisturbed)

    def test_term_to_one_rank_keeps_and_stops(self):
        process = self.start_keeping(1000)
        os.kill(ranks_of(process)[1], signal.SIGTERM)
        job = self.end(process)
        self.assertEqual(job.code, 75, str(job))
        self.assertEqual(len(self.strips()), 2)

    def test_signals_without_checkpoint(self):
        process = self.start_slow()
        process.send_signal(signal.SIGUSR1)
        self.assertIn("SIGUSR1", lines_until(process.stderr, "warning: ")[-1])
        process.send_signal(signal.SIGUSR2)
        job = self.end(process)
        self.assertEqual(job.code, 75, str(job))
        self.assertIn("nothing is kept", job.said[0])
        self.assertEqual(job.warnings, [], "it is told once")

    def start_iterating(self):
        """A job in its solve, which lasts; an end of it would be told by its residual."""
        process = launch(["solve", *MATRIX, CORNELL, "--resolution", "80x80", "--threads", "1", "--solver", "jacobi",
                          "--form-factor", "disc", "--tolerance", "1e-30", "--max-iterations", "1000000",
                          "--out", self.out])
        lines_until(process.stdout, "form factors")
        return process

    def check_stopped(self, process, *untold):
        job = self.end(process)
        self.assertEqual(job.code, 75, str(job))
        self.assertLess(job.seconds, 10)
        for word in untold:
            self.assertNotIn(word, job.out)

    def test_usr2_stops_the_solve(self):
        process = self.start_iterating()
        process.send_signal(signal.SIGUSR2)
        self.check_stopped(process, "residual")

    def test_usr2_to_any_rank_stops_the_solve(self):
        for rank in (0, 1):
            process = self.start_iterating()
            os.kill(ranks_of(process)[rank], signal.SIGUSR2)
            self.check_stopped(process, "residual")

    def test_usr2_stops_the_form_factors(self):
        for ranks in (1, 3):
            shutil.rmtree(self.folder, ignore_errors=True)
            # Some seconds of rays.
            process = launch(["solve", *MATRIX, CORNELL, "--resolution", "64x64", "--threads", "1", "--form-factor",
                              "points:3x3", "--checkpoint", self.folder, "--out", self.out], ranks)
            lines_until(process.stdout, "checkpoint")
            self.wait_for_work(process, 0.5)
            process.send_signal(signal.SIGUSR2)
            self.check_stopped(process, "form factors")

    def test_the_timeline_of_the_visibility_alone(self):
        self.assert_done(self.keep(*SMALL, "--visibility-only", "--timeline"))
        rows = (self.out / "timeline.csv").read_text().splitlines()[1:]
        self.assertEqual({tuple(row.split(",")[:2]) for row in rows}, {("visibility", "0"), ("visibility", "1")})
        self.assertEqual(self.report()["warnings"], [])

    def test_a_killed_rank_loses_what_came_since_the_last_write(self):
        undisturbed = self.undisturbed(*SLOW)
        process = self.start_keeping(0.3, ranks=2)
        self.wait_for(lambda: len(self.strips()) == 2, process)
        os.kill(ranks_of(process)[0], signal.SIGKILL)
        job = self.end(process)
        self.assertNotIn(job.code, (0, None), str(job))
        _, report = self.resume(*SLOW, ranks=3)
        self.check_resumed(report, undisturbed)

    def test_light_and_reflectance_may_change(self):
        self.assert_done(self.keep(*SMALL, "--visibility-only", "--solver", "cg"))
        self.assertFalse((self.out / "solution.ply").exists())
        before = [(file, file.read_bytes()) for file in self.strips()]
        for file in CORNELL.parent.iterdir():
            shutil.copy(file, self.work)
        changed = self.work / "cornell-box.toml"
        mtl = self.work / "cornell-box.mtl"
        mtl.write_text(mtl.read_text().replace("Kd 0.", "Kd 0.1"))
        changed.write_text(changed.read_text() + '\n[materials.light]\nE = [3.0, 2.0, 1.0]\n')
        arguments = (changed, *SMALL[1:], "--solver", "jacobi")
        self.assert_done(self.solve(*arguments, ranks=1))
        anew, solution = self.report(), (self.out / "solution.ply").read_bytes()
        self.assert_done(self.solve(*arguments, "--reuse-visibility", self.folder, ranks=3))
        report = self.report()
        self.check_resumed(report, anew)
        self.assertEqual(report["visibility"]["tiles_computed"], 0)
        self.assertTrue((self.out / "solution.ply").read_bytes() == solution, "solution.ply differs")
        self.assertEqual([(file, file.read_bytes()) for file in self.strips()], before)

    def test_reuse_says_what_is_missing(self):
        self.folder.mkdir()
        job = self.solve(*SMALL, "--reuse-visibility", self.folder)
        self.assert_done(job)
        self.assertIn("holds no strips of these elements", "\n".join(job.warnings))
        self.out = self.work / "refused"
        self.assert_refused(self.solve(*SMALL, "--reuse-visibility", self.work / "none"), file=self.work / "none")

    def test_strips_are_not_written_over_unasked(self):
        self.assert_done(self.keep(*SMALL, "--visibility-only"))
        job = self.keep(*SMALL)
        self.assertEqual(job.code, 2, str(job))
        self.assertIn("--resume", job.said[0])
        self.assertIn(str(self.folder), job.said[0])

    def test_resume_of_nothing_starts(self):
        job, report = self.resume(*SMALL)
        self.assertEqual((report["visibility"]["tiles_resumed"], job.warnings), (0, []))

    def test_options_that_need_a_folder(self):
        for option in ("--resume", "--visibility-only"):
            job = self.solve(*SMALL, option)
            self.assertEqual(job.code, 2, str(job))
            self.assertIn(option + " needs --checkpoint", job.said[0])
        self.assertEqual(self.keep(*SMALL, "--checkpoint-every", 0).code, 2)

    def test_a_full_disk_is_told_and_survived(self):
        self.folder.mkdir()
        mount = ["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", self.folder]
        if os.geteuid() != 0 or subprocess.run(mount, capture_output=True, check=False).returncode != 0:
            self.skipTest("a small disk cannot be mounted here")
        self.addCleanup(subprocess.run, ["umount", "-l", self.folder], check=False)
        job = self.keep(*SLOW, "--checkpoint-every", "0.2")
        self.assert_done(job)
        self.assertEqual(sum("cannot be kept, and the run goes on" in line for line in job.warnings), 1, str(job))
        self.assertEqual(sum("the checkpoint is not complete" in line for line in job.warnings), 1, str(job))
        self.assertIn("No space left", "\n".join(self.report()["warnings"]))
        job = self.keep(*SLOW, "--visibility-only", "--resume")
        self.assertEqual(job.code, 2, str(job))
        self.assertIn("No space left", job.said[0])


if __name__ == "__main__":
    unittest.main()
