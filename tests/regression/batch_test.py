"""The scripts for Slurm, with stand-ins for its commands: memory by a forecast, requeues while the checkpoint grows."""

import os
import stat
import subprocess
import unittest

from fluxel_job import MATRIX, MPI_ENVIRONMENT, SCENES, JobTest, start

CLUSTER = SCENES.parent / "scripts/cluster"
CORNELL = SCENES / "cornell-box" / "cornell-box.toml"

# Each as the command of its name, as far as the scripts use it.
SRUN = """#!/bin/sh
while [ "${1#--}" != "$1" ]; do shift; done
exec "$@"
"""
RECORD = """#!/bin/sh
printf '%s\\n' "$(basename "$0")" "$@" >>"$RECORD"
"""
# Adds tiles or rounds to the checkpoint as long as GROWTH has any, a word for each start, then stops as on SIGUSR2.
FAKE_FLUXEL = """#!/usr/bin/env python3
import os, pathlib, struct, sys
folder = pathlib.Path(sys.argv[sys.argv.index("--checkpoint") + 1])
folder.mkdir(exist_ok=True)
what, number = os.environ["GROWTH"].split()[int(os.environ["SLURM_RESTART_COUNT"])].split(":")
if what == "tiles":
    for rank in range(2):
        end = struct.pack("<8s5Q", b"FLXRANGE", int(number), int(number), 0, 0, 0)
        (folder / f"strips-0123456789abcdef-{rank}-of-2.fxs").write_bytes(b"tiles" + end)
elif what == "round":
    for file in folder.glob("links-*"):
        file.unlink()
    (folder / f"links-0123456789abcdef-{number}-0-of-1.fxr").touch()
sys.exit(0 if what == "end" else 75)
"""


class BatchTest(JobTest):
    def setUp(self):
        super().setUp()
        self.bin = self.work / "bin"
        self.bin.mkdir()
        for name, text in (("srun", SRUN), ("scontrol", RECORD), ("sbatch", RECORD), ("fake", FAKE_FLUXEL)):
            self.command(name, text)
        self.record = self.work / "record"

    def command(self, name, text):
        file = self.bin / name
        file.write_text(text)
        file.chmod(file.stat().st_mode | stat.S_IXUSR)
        return file

    def run_script(self, name, *arguments, **environment):
        self.record.write_text("")
        settings = {**os.environ, **MPI_ENVIRONMENT, "PATH": f"{self.bin}:{os.environ['PATH']}", "RECORD": str(self.record),
                    "FLUXEL": os.environ["FLUXEL"], **environment}
        job = subprocess.run(["bash", CLUSTER / name, *map(str, arguments)], env=settings, cwd=self.work, text=True,
                             stdin=subprocess.DEVNULL, capture_output=True, check=False)
        return job, self.record.read_text().splitlines()

    def start_job(self, restarts, growth="", fluxel="fake", *arguments):
        return self.run_script("fluxel.sbatch", *arguments, FLUXEL=str(fluxel), GROWTH=growth, SLURM_JOB_ID="7",
                               SLURM_SUBMIT_DIR=str(self.work), SLURM_CPUS_PER_TASK="1", SLURM_RESTART_COUNT=str(restarts))

    def requeues_until_the_end(self, growth):
        """How often a job goes back into the queue, and how its last start ends."""
        for restarts in range(len(growth.split())):
            job, calls = self.start_job(restarts, growth)
            if calls == []:
                return restarts, job
            self.assertEqual(calls, ["scontrol", "requeue", "7"])
            self.assertEqual(job.returncode, 75, job.stderr)
        self.fail("the job goes back into the queue for ever")

    def test_a_job_is_requeued_while_its_checkpoint_grows(self):
        for growth in ("tiles:10 tiles:20 tiles:21 tiles:22 end:", "round:1 round:2 round:2 round:10 end:"):
            restarts, job = self.requeues_until_the_end(growth)
            self.assertEqual((restarts, job.returncode), (4, 0), job.stderr)

    def test_two_requeues_without_progress_end_a_job(self):
        for growth, expected in (("none: none: none: none:", 2), ("round:3 round:3 round:3 round:3", 2),
                                 ("tiles:5 tiles:9 tiles:9 tiles:9 tiles:9", 3)):
            restarts, job = self.requeues_until_the_end(growth)
            self.assertEqual((restarts, job.returncode), (expected, 1), job.stderr)
            self.assertIn("has not grown in two requeues", job.stderr)
        # A new job begins to count anew.
        self.assertEqual(self.start_job(0, "tiles:9")[1], ["scontrol", "requeue", "7"])

    def test_tiles_of_a_real_checkpoint_are_counted(self):
        out = self.work / "fluxel-7"
        self.assert_done(start(["solve", *MATRIX, CORNELL, "--resolution", "16x16", "--checkpoint", out / "checkpoint",
                                "--visibility-only", "--out", out], 2))
        visibility = self.report(out)["visibility"]
        _, calls = self.start_job(0, "none:")
        self.assertEqual(calls, ["scontrol", "requeue", "7"])
        self.assertEqual((out / "requeues").read_text(), f"{visibility['tiles_uniform'] + visibility['tiles_mixed']}\n")

    def test_memory_is_what_a_dry_run_forecasts(self):
        asked = []
        for method in ((), MATRIX):
            arguments = (CORNELL, "--resolution", "16x16", *method)
            job, calls = self.run_script("submit", "--nodes=2", "--ntasks-per-node", 3, "--", *arguments)
            self.assertEqual(job.returncode, 0, job.stderr)
            self.assertRegex(calls[1], r"^--mem=\d+M$")
            self.assertEqual(calls[2:], ["--nodes=2", "--ntasks-per-node", "3", str(CLUSTER / "fluxel.sbatch"),
                                         *map(str, arguments)])
            self.assertIn(calls[1], job.stderr)
            self.assert_done(start(["solve", *arguments, "--dry-run", "--out", self.out], 1))
            report = self.report()
            forecast = report["forecast"]["bytes_max"] if method == () else report["memory"]["predicted_bytes_max"]
            expected = 2 * (forecast + 3 * report["memory"]["peak_rss_bytes_max"]) / 2**20
            asked.append(int(calls[1][6:-1]))
            self.assertAlmostEqual(asked[-1], expected, delta=0.3 * expected)
        job, calls = self.run_script("submit", "--ntasks-per-node=3", "--", *arguments, FLUXEL_MEMORY_MARGIN="4")
        self.assertAlmostEqual(int(calls[1][6:-1]), 2 * asked[-1], delta=0.3 * asked[-1])

    def test_errors_of_submit_are_told_and_nothing_is_submitted(self):
        for arguments, environment, text in (
                ((CORNELL,), {}, "usage: submit"), (("--mem=1G", "--", CORNELL), {}, "--mem=1G"),
                (("--ntasks-per-node=0", "--", CORNELL), {}, "--ntasks-per-node"),
                (("--", CORNELL), {"FLUXEL_MEMORY_MARGIN": "much"}, "FLUXEL_MEMORY_MARGIN"),
                (("--", self.work / "none.obj"), {}, "none.obj"), (("--", CORNELL, "--no-such"), {}, "the dry run has failed")):
            job, calls = self.run_script("submit", *arguments, **environment)
            self.assertEqual((job.returncode, calls), (2, []), job.stderr)
            self.assertIn(text, job.stderr)


if __name__ == "__main__":
    unittest.main()
