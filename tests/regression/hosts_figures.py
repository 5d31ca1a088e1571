#!/usr/bin/python3
"""What a run costs on several hosts: seconds, bytes between hosts, memory of a host. Prints the rows of bench/results/hosts.md.

    FLUXEL=.../app/fluxel tests/regression/hosts_figures.py [RESOLUTION]

Needs root: the hosts are network namespaces of this machine. They share its cores, so that seconds tell what a network
costs and nothing about speed-up.
"""

import json
import sys
import tempfile
from pathlib import Path

from fluxel_job import MATRIX, SCENES
from hosts import Hosts, Unavailable
from hosts_job import HostsJob

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
CASES = ((1, 4, 0, 0), (2, 2, 0, 0), (2, 2, 20, 1), (3, 2, 20, 1))  # hosts, ranks a host, ms one way, % lost


def megabytes(values):
    return ", ".join(f"{value / 1e6:.1f}" for value in values)


def row(resolution, hosts, ranks_a_host, delay_ms, loss_percent):
    with tempfile.TemporaryDirectory(prefix="fluxel-") as work, Hosts(hosts, delay_ms, loss_percent) as network:
        out = Path(work) / "out"
        job = HostsJob(network, ranks_a_host, work, "solve", *MATRIX, CORNELL, "--resolution", resolution, "--threads",
                       1, "--out", out)
        ended = job.finish(limit=300)
        if ended.code != 0:
            sys.exit(str(ended))
        report = json.loads((out / "report.json").read_text())
        path = "one host" if hosts == 1 else f"{network.network}, {delay_ms} ms, {loss_percent} %"
        return (f"| {hosts} x {ranks_a_host} | {path} | {report['time_s']['total']:.1f} | {ended.seconds:.1f} "
                f"| {megabytes(job.sent_bytes().values())} | {report['visibility']['message_bytes'] / 1e6:.2f} "
                f"| {report['solve']['gathered_bytes_a_host'] / 1e6:.1f} | {megabytes(job.peak_bytes().values())} "
                f"| {report['memory']['peak_rss_bytes_max'] / 1e6:.1f} |"), report


def main():
    resolution = sys.argv[1] if len(sys.argv) > 1 else "128x128"
    print("| hosts x ranks | network | run [s] | with launch [s] | sent by each host [MB] | tiles sent [MB] "
          "| gathered a rank [MB] | peak of each host's ranks [MB] | largest rank [MB] |")
    print("| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    hashes = set()
    for case in CASES:
        text, report = row(resolution, *case)
        print(text, flush=True)
        hashes.add((report["elements"], report["hash"]["elements"], report["hash"]["visibility"]))
    print(f"\n(elements, their hash, hash of the bits) of all: {hashes}")


if __name__ == "__main__":
    try:
        main()
    except Unavailable as reason:
        sys.exit(f"no hosts on this machine: {reason}")
