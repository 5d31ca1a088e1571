"""Starts Fluxel across the hosts of `hosts.py`, and measures what it takes on each."""

import os
import subprocess
import time
from pathlib import Path

from fluxel_job import MPI_ENVIRONMENT, Job
from hosts import SUBNET, Unavailable, kill_all, processes, run
from report_schema import check_reports, output_folder

MPIEXEC = os.environ.get("FLUXEL_MPIEXEC", "mpirun")

# Starts a command on a host, as ssh would: AGENT HOST COMMAND
AGENT = """#!/bin/sh
host=$1
shift
exec ip netns exec "$host" unshare --uts sh -c 'hostname "$0" && exec sh -c "$1"' "$host" "$*"
"""

# Where a host says nothing for 2 + 3 * 1 seconds, it is lost. Open MPI's own patience is 300 + 9 * 20 seconds.
KEEPALIVE = {"oob_tcp_keepalive_time": 2, "oob_tcp_keepalive_intvl": 1, "oob_tcp_keepalive_probes": 3}


def require_launcher():
    """Throws Unavailable where the launcher is not the one whose parameters are known here."""
    version = run(MPIEXEC, "--version").splitlines()[0]
    if "(Open MPI) 4." not in version and "(OpenRTE) 4." not in version:
        raise Unavailable(f"the launch across hosts is written for Open MPI 4, not for {version}")


class HostsJob:
    """`fluxel ARGUMENTS` on all hosts, `ranks_a_host` on each, from the first one. What it says is in `folder`."""

    def __init__(self, hosts, ranks_a_host, folder, *arguments):
        require_launcher()
        self.hosts, self.folder, self.arguments, self.since = hosts, Path(folder), arguments, time.time()
        self.peaks = {name: {} for name in hosts.names}  # of each host's ranks, by process [bytes]
        self.begin = time.monotonic()
        self.sent_before = hosts.sent_bytes()
        agent = self.folder / "agent"
        agent.write_text(AGENT)
        agent.chmod(0o755)
        parameters = {"plm_rsh_agent": agent, "plm_rsh_no_tree_spawn": 1, "oob_tcp_if_include": SUBNET,
                      "btl_tcp_if_include": SUBNET, "orte_tmpdir_base": self.folder, **KEEPALIVE}
        mpirun = [MPIEXEC, "--bind-to", "none", "-H", ",".join(f"{name}:{ranks_a_host}" for name in hosts.names)]
        for name, value in parameters.items():
            mpirun += ["--mca", name, value]
        with open(self.folder / "out.txt", "w") as out, open(self.folder / "err.txt", "w") as err:
            self.process = subprocess.Popen(hosts.command(hosts.names[0], *mpirun, os.environ["FLUXEL"], *arguments),
                                            env={**os.environ, **MPI_ENVIRONMENT}, stdin=subprocess.DEVNULL, stdout=out,
                                            stderr=err)

    def said(self):
        return (self.folder / "out.txt").read_text()

    def wait_for(self, text, limit=60):
        """Until the job has said it; an AssertionError where it ends before."""
        end = time.monotonic() + limit
        while text not in self.said():
            assert self.process.poll() is None and time.monotonic() < end, f"'{text}' was never said\n{self._job(None)}"
            time.sleep(0.02)

    def finish(self, limit=120):
        """The finished job; with code None where it took longer than `limit` seconds, all its processes killed."""
        end = time.monotonic() + limit
        while self.process.poll() is None:
            if time.monotonic() > end:
                kill_all(*self.hosts.names)
                self.process.wait()
                return self._job(None)
            self._look_at_memory()
            time.sleep(0.05)
        if output_folder(self.arguments):
            check_reports(output_folder(self.arguments), self.since)
        return self._job(self.process.returncode)

    def peak_bytes(self):
        """Of each host: the sum of its ranks' largest resident sets, as seen 20 times a second."""
        return {host: sum(peaks.values()) for host, peaks in self.peaks.items()}

    def sent_bytes(self):
        """Of each host: what has left it since the start, with all headers."""
        return {host: sent - self.sent_before[host] for host, sent in self.hosts.sent_bytes().items()}

    def _job(self, code):
        return Job(code, self.said(), (self.folder / "err.txt").read_text(), time.monotonic() - self.begin)

    def _look_at_memory(self):
        for host in self.hosts.names:
            for number in processes(host):
                try:
                    status = Path(f"/proc/{number}/status").read_text()
                except OSError:
                    continue  # it has ended meanwhile
                values = dict(line.split(":\t", 1) for line in status.splitlines() if ":\t" in line)
                if values["Name"] == Path(os.environ["FLUXEL"]).name and "VmHWM" in values:
                    self.peaks[host][number] = 1024 * int(values["VmHWM"].split()[0])
