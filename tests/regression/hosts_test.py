"""Three hosts on this machine, as network namespaces, with delay and loss between them; and a host that is lost."""

import time
import unittest

from fluxel_job import MATRIX, SCENES, JobTest
from hosts import Hosts, Unavailable, kill_all, processes
from hosts_job import HostsJob

CORNELL = SCENES / "cornell-box" / "cornell-box.toml"
LOST = "lost communication with a remote daemon"  # Open MPI's words


class HostsTest(JobTest):
    def three_hosts(self, **settings):
        try:
            return self.enterContext(Hosts(3, **settings))
        except Unavailable as reason:
            self.skipTest(f"no hosts on this machine: {reason}")

    def start_on(self, hosts, *arguments):
        try:
            return HostsJob(hosts, 2, self.work, "solve", *MATRIX, CORNELL, *arguments, "--threads", 1, "--out",
                            self.out)
        except Unavailable as reason:
            self.skipTest(str(reason))

    def test_delay_and_loss_change_no_byte(self):
        hosts = self.three_hosts(delay_ms=20, loss_percent=1)
        round_trip = hosts.round_trip_ms()
        self.assertGreater(round_trip, 39)
        self.assertLess(round_trip, 300)

        self.assert_done(self.solve(CORNELL, "--resolution", "48x48", "--threads", 1, "--quiet", ranks=1))
        alone, solution = self.report(), (self.out / "solution.ply").read_bytes()
        job = self.start_on(hosts, "--resolution", "48x48")
        self.assert_done(job.finish())
        among = self.report()
        self.assertEqual([rank["host"] for rank in among["ranks_detail"]], sorted(2 * hosts.names))
        self.assertEqual(among["hash"], alone["hash"])
        self.assertEqual(among["solve"]["iterations"], alone["solve"]["iterations"])
        self.assertTrue((self.out / "solution.ply").read_bytes() == solution, "solution.ply differs")

        # What a host gathers is of the others; hosts own rows of about the same cost, not quite the same number.
        sent = job.sent_bytes()
        gathered, messages = among["solve"]["gathered_bytes_a_host"], among["visibility"]["message_bytes"]
        self.assertGreater(sum(sent.values()), len(hosts.names) * 0.8 * gathered)
        # A rank is never smaller than its libraries.
        peaks = job.peak_bytes()
        for host in hosts.names:
            self.assertGreater(peaks[host], 2 * 10e6, host)
        print(f"\nnetwork: {hosts.network}, {round_trip:.1f} ms there and back; run of {job.finish().seconds:.1f} s\n"
              f"sent by each host: {list(sent.values())} bytes; gathered {gathered} a host, tiles {messages} in all\n"
              f"peak memory of each host's ranks: {list(peaks.values())} bytes", flush=True)

        hosts.close()
        if hosts.network == "relay":
            counts = hosts.relay_counts
            print(f"relay: {counts['frames']} frames, {counts['lost']} lost", flush=True)
            self.assertGreater(counts["frames"], 1000)
            self.assertGreater(counts["lost"], 0.005 * counts["frames"])
            self.assertLess(counts["lost"], 0.02 * counts["frames"])

    def check_end(self, job, hosts, lost, since):
        """A lost host ends the job within seconds, with its name, and nobody computes on, on either side."""
        ended = job.finish(limit=60)
        self.assertLess(time.monotonic() - since, 20, str(ended))
        self.assertNotIn(ended.code, (0, None), str(ended))
        self.assertIn(LOST, ended.err)
        self.assertIn(f"on node {lost}", ended.err)
        self.assertNotIn("solution.ply", self.written())
        while any(processes(host) for host in hosts.names):
            self.assertLess(time.monotonic() - since, 30, "ranks are left over")
            time.sleep(0.1)

    def test_a_host_that_dies_ends_the_job(self):
        hosts = self.three_hosts()
        job = self.start_on(hosts, "--resolution", "128x128", "--trace-every-pair")
        job.wait_for("forecast:")
        since = time.monotonic()
        kill_all(hosts.names[2])
        self.check_end(job, hosts, hosts.names[2], since)

    def test_a_host_that_falls_silent_ends_the_job(self):
        hosts = self.three_hosts()
        job = self.start_on(hosts, "--resolution", "200x200")
        job.wait_for("visibility:")
        since = time.monotonic()
        hosts.cut(hosts.names[2])
        self.check_end(job, hosts, hosts.names[2], since)


if __name__ == "__main__":
    unittest.main()
