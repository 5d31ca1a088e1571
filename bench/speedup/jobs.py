"""Runs of Fluxel under mpirun, each with what it took: by the clock, by all processors, by phase and by rank."""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FLUXEL = ROOT / "build/release/app/fluxel"
SCENE = ROOT / "scenes/office-2391/office-2391.toml"
PHASES = ("load", "subdivision", "forecast", "visibility", "form_factors", "solve", "image")


@dataclass
class Run:
    """One job. Seconds; `cpu` holds user and system time of all ranks and of the launcher."""

    ranks: int
    elements: int
    wall: float
    cpu: float
    phase_wall: dict
    phase_cpu: dict
    idle: float
    bytes_sent: int
    hash: str


def run(ranks, resolution):
    """One rank, one thread."""
    with tempfile.TemporaryDirectory(prefix="fluxel-speedup-") as folder:
        command = ["mpirun", "-np", str(ranks), "--bind-to", "none", str(FLUXEL), "solve", str(SCENE), "--method", "matrix",
                   "--quiet", "--no-error-estimate", "--threads", "1", "--resolution", resolution, "--out", folder]
        with tempfile.TemporaryFile("w+") as said:
            start = time.monotonic()
            process = subprocess.Popen(command, stdout=said, stderr=said, stdin=subprocess.DEVNULL)
            # The launcher has waited for its ranks, so that its usage holds theirs.
            _, status, usage = os.wait4(process.pid, 0)
            wall = time.monotonic() - start
            process.returncode = os.waitstatus_to_exitcode(status)
            if process.returncode != 0:
                said.seek(0)
                sys.exit(f"{' '.join(command)}\nended with {process.returncode}:\n{said.read()}")
        report = json.loads((Path(folder) / "report.json").read_text())
    return Run(ranks, report["elements"], wall, usage.ru_utime + usage.ru_stime,
               {phase: report["time_s"].get(phase, 0) for phase in PHASES},
               {phase: report["cpu_s"].get(phase, 0) for phase in PHASES}, idle_share(report),
               sum(part["bytes_sent"] for part in scheduled_parts(report)),
               report["hash"]["visibility"])


def scheduled_parts(report):
    """What each rank did in each phase whose work is scheduled."""
    return [rank[phase] for rank in report["ranks_detail"] for phase in ("visibility", "corrections") if phase in rank]


def idle_share(report):
    """Of all ranks' time in these phases, what was spent waiting for work, tiles or the others."""
    parts = scheduled_parts(report)
    waiting = sum(part["waiting_s"] for part in parts)
    return waiting / (waiting + sum(part["busy_s"] + part["message_s"] for part in parts))


def median_run(runs):
    """The run of median wall-clock time; of an even number the faster one in the middle."""
    return sorted(runs, key=lambda run: run.wall)[(len(runs) - 1) // 2]


def spread(runs):
    """Of the wall-clock times, half the range over the median."""
    times = [run.wall for run in runs]
    return 0.5 * (max(times) - min(times)) / statistics.median(times)


def cores():
    return len(os.sched_getaffinity(0))
