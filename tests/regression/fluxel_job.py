"""Starts Fluxel as a user does, under the MPI launcher, and keeps what it said.

Whatever JSON reports a run leaves are validated against docs/schema, as part of the test that started it.

FLUXEL names the program, FLUXEL_MPIEXEC the launcher (default: mpirun), FLUXEL_NUMPROC_FLAG its option (default: -np).
"""

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from report_schema import check_reports, output_folder

SCENES = Path(__file__).resolve().parents[2] / "scenes"
sys.path[:0] = [str(SCENES.parent / folder) for folder in ("bench", "python")]

import fluxel.jobs

MATRIX = ("--method", "matrix")
OUTPUTS = ("convergence.csv", "image.exr", "image.png", "report.html", "report.json", "solution.ply")
PHASES = ("load", "subdivision", "visibility", "coarser meshes", "escape fractions", "power estimate", "corrections",
          "row sums", "solve", "image", "audit")

# More ranks than cores, as root, in containers; and no second of grace when a job fails.
MPI_ENVIRONMENT = {
    "OMPI_ALLOW_RUN_AS_ROOT": "1",
    "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "PRTE_ALLOW_RUN_AS_ROOT": "1",
    "PRTE_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
    "OMPI_MCA_rmaps_base_oversubscribe": "1",
    "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
    "OMPI_MCA_mpi_yield_when_idle": "1",
    "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
    "OMPI_MCA_pml": "ob1",  # other transports are looked for in vain, 0.2 s a job
    "OMPI_MCA_odls_base_sigkill_timeout": "0",
}


class Job:
    """A finished run: exit code, both streams, seconds."""

    def __init__(self, code, out, err, seconds):
        self.code, self.out, self.err, self.seconds = code, out, err, seconds

    @property
    def said(self):
        """Fluxel's own messages on standard error; the launcher has some of its own."""
        return [line for line in self.err.splitlines() if line.startswith("fluxel: ")]

    @property
    def warnings(self):
        return [line for line in self.err.splitlines() if line.startswith("warning: ")]

    def __str__(self):
        return f"exit code {self.code} after {self.seconds:.1f} s\n--- out\n{self.out}\n--- err\n{self.err}"


class Launched(subprocess.Popen):
    """A launcher's process, whose reports are validated when it has ended."""

    def __init__(self, arguments, *words, **settings):
        self.folder, self.since = output_folder(arguments), time.time()
        super().__init__(*words, **settings)

    def communicate(self, *words, **settings):
        said = super().communicate(*words, **settings)
        if self.folder:
            check_reports(self.folder, self.since)
        return said


def validated(finished):
    """The same of what the Python package runs."""
    def run(line, *words):
        since = time.time()
        ended = finished(line, *words)
        check_reports(output_folder(line), since)
        return ended
    return run


fluxel.jobs._finished = validated(fluxel.jobs._finished)


def launch(arguments, ranks=2, address_space_kb=None, program=None):
    """Starts `fluxel ARGUMENTS`, or another program, and returns the launcher's process."""
    program = [str(program or os.environ["FLUXEL"]), *map(str, arguments)]
    if address_space_kb:
        program = ["sh", "-c", f'ulimit -v {address_space_kb}; exec "$@"', "sh", *program]
    launcher = [os.environ.get("FLUXEL_MPIEXEC", "mpirun"), "--bind-to", "none",
                os.environ.get("FLUXEL_NUMPROC_FLAG", "-np"), str(ranks)]
    return Launched(arguments, launcher + program, env={**os.environ, **MPI_ENVIRONMENT}, text=True,
                    stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True)


def ranks_of(process):
    """The processes of a job's ranks, ascending: the launcher's children."""
    children = Path(f"/proc/{process.pid}/task").glob("*/children")
    return sorted(int(pid) for file in children for pid in file.read_text().split())


def processor_seconds(pid):
    """What a process has used, user and system; 0 where it is no more."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def lines_until(stream, word):
    """The lines that a job says, up to the first that begins with `word`; all of them where it ends before."""
    lines = []
    for line in stream:
        lines.append(line)
        if line.startswith(word):
            break
    return lines


def start(arguments, ranks=2, limit=180, address_space_kb=None, program=None):
    """Runs `fluxel ARGUMENTS`, or another program; a run that takes longer than `limit` seconds is killed and has code None."""
    begin = time.monotonic()
    return finish(launch(arguments, ranks, address_space_kb, program), begin, limit)


def finish(process, begin, limit=180):
    """Waits for a launcher's process that began then."""
    try:
        out, err = process.communicate(timeout=limit)
        code = process.returncode
    except subprocess.TimeoutExpired:
        code = None
        os.killpg(process.pid, signal.SIGTERM)
        try:
            out, err = process.communicate(timeout=10)
        except subprocess.TimeoutExpired:  # the launcher hangs itself
            ranks = ranks_of(process)
            for pid in (process.pid, *ranks):
                os.kill(pid, signal.SIGKILL)
            out, err = process.communicate()
    return Job(code, out, err, time.monotonic() - begin)


class JobTest(unittest.TestCase):
    """A test with a folder of its own for scenes, `self.work`, and one for output, `self.out`."""

    method = MATRIX  # of self.solve, before what a test gives, which counts; () for the program's own choice

    def setUp(self):
        self.work = Path(tempfile.mkdtemp(prefix="fluxel-"))
        self.addCleanup(shutil.rmtree, self.work, ignore_errors=True)
        self.out = self.work / "out"

    def write(self, name, text):
        file = self.work / name
        file.write_text(text)
        return file

    def solve(self, *arguments, **settings):
        return start(["solve", *self.method, *arguments, "--out", self.out], **settings)

    def wait_for(self, what, process, seconds=60):
        """Until `what` is true of a running job."""
        end = time.monotonic() + seconds
        while not what():
            self.assertIsNone(process.poll(), "the job has ended too early: " + str(process.poll()))
            self.assertLess(time.monotonic(), end, "waited in vain")
            time.sleep(0.02)

    def wait_for_work(self, process, seconds):
        """Until every rank has used so much more processor time: what it is at is then well under way, however busy the
        machine is."""
        goals = {pid: processor_seconds(pid) + seconds for pid in ranks_of(process)}
        self.wait_for(lambda: all(processor_seconds(pid) >= goal for pid, goal in goals.items()), process)

    def report(self, out=None):
        return json.loads(((out or self.out) / "report.json").read_text())

    def written(self):
        """Names of all files in the output folder, also of temporary ones."""
        return sorted(file.name for file in self.out.iterdir()) if self.out.is_dir() else []

    def assert_done(self, job, code=0):
        self.assertEqual(job.code, code, str(job))
        self.assertEqual(job.said, [], str(job))

    def assert_refused(self, job, *texts, file=None, line=None):
        """Ended with 2 within seconds; one message, from one rank, with its place; no file left."""
        self.assertEqual(job.code, 2, str(job))
        self.assertLess(job.seconds, 10)
        self.assertEqual(len(job.said), 1, str(job))
        place = f"{file}:{line}: " if line else f"{file}: " if file else ""
        self.assertTrue(job.said[0].startswith("fluxel: " + place), f"not at {place}\n{job}")
        for text in texts:
            self.assertIn(text, job.said[0])
        self.assertEqual(self.written(), [])


def option_key(option):
    """The key of an option in a report."""
    return option.removeprefix("--").replace("-", "_")


def line_of(text, part):
    """The number of the one line that holds `part`."""
    lines = [number for number, line in enumerate(text.splitlines(), 1) if part in line]
    assert len(lines) == 1, (part, lines)
    return lines[0]


def solution_header(file):
    """The header lines of a PLY file."""
    data = file.read_bytes()
    return data[:data.index(b"end_header\n")].decode().splitlines()

