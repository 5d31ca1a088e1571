"""Several hosts on one machine: network namespaces with host names of their own, joined by a network with delay and loss."""

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

SUBNET = "198.18.0.0/24"  # for measurements between networks (RFC 2544); nothing outside the namespaces sees it
RELAY = Path(__file__).with_name("tap_relay.py")


class Unavailable(Exception):
    """Why this machine can have no hosts."""


def run(*command):
    """What the command printed; a RuntimeError with its complaint where it fails."""
    done = subprocess.run([str(word) for word in command], text=True, capture_output=True)
    if done.returncode != 0:
        raise RuntimeError(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return done.stdout


def require_hosts():
    """Throws Unavailable with the reason where hosts cannot be made."""
    if os.geteuid() != 0:
        raise Unavailable("network namespaces need root")
    for tool in ("ip", "tc", "unshare"):
        if shutil.which(tool) is None:
            raise Unavailable(f"there is no program '{tool}' (Debian: iproute2, util-linux)")
    # In a container root may be refused a namespace, or a name of its own for a host.
    probe = subprocess.run(["unshare", "--net", "--uts", "--mount", "true"], text=True, capture_output=True)
    if probe.returncode != 0:
        raise Unavailable(probe.stderr.strip())


def processes(host):
    """Numbers of the processes that run there."""
    try:
        namespace = os.stat(f"/run/netns/{host}").st_ino
    except FileNotFoundError:
        return []
    found = []
    for folder in Path("/proc").glob("[0-9]*"):
        try:
            if os.stat(folder / "ns" / "net").st_ino == namespace:
                found.append(int(folder.name))
        except OSError:
            pass  # it has ended meanwhile
    return found


def kill_all(*hosts):
    """Ends all that runs there, as when the power goes."""
    for _ in range(100):  # what is started meanwhile is found next time
        left = [number for host in hosts for number in processes(host)]
        if not left:
            return
        for number in left:
            try:
                os.kill(number, signal.SIGKILL)
            except ProcessLookupError:
                pass
        time.sleep(0.01)


def remove(*hosts):
    kill_all(*hosts)
    for host in hosts:
        subprocess.run(["ip", "netns", "delete", host], capture_output=True)


def remove_stale_hosts():
    """What processes left that were killed before they could remove their hosts."""
    for file in Path("/run/netns").glob("fx*"):
        maker = re.fullmatch(r"fx(\d+)(h\d+|s)", file.name)
        if maker and not Path("/proc", maker[1]).exists():
            remove(file.name)


class Hosts:
    """Hosts, up to the end of the scope; Unavailable where this machine cannot have them.

    Packets wait `delay_ms` one way and are lost with `loss_percent`. `network` says what does that: "netem", a "relay" of
    TAP devices where the kernel has no netem, or a "bridge" where there is nothing to do. `relay_counts` is what has passed
    the relay, after the end.
    """

    def __init__(self, count, delay_ms=0, loss_percent=0):
        require_hosts()
        self.delay_ms, self.loss_percent = delay_ms, loss_percent
        self.names = [f"fx{os.getpid()}h{number}" for number in range(1, count + 1)]
        self.switch = f"fx{os.getpid()}s"
        self.relay, self.relay_counts = None, None

    def __enter__(self):
        remove_stale_hosts()
        try:
            for name in (*self.names, self.switch):
                run("ip", "netns", "add", name)
                run("ip", "-n", name, "link", "set", "lo", "up")
            delayed = self.delay_ms or self.loss_percent
            self.network = "bridge" if not delayed else "netem" if self._has_netem() else "relay"
            self._join_by_relay() if self.network == "relay" else self._join_by_bridge()
            for number, name in enumerate(self.names, 1):
                run("ip", "-n", name, "address", "add", f"198.18.0.{number}/24", "dev", "eth0")
                run("ip", "-n", name, "link", "set", "eth0", "up")
            return self
        except BaseException:
            self.close()
            raise

    def __exit__(self, *_):
        self.close()

    def close(self):
        remove(*self.names, self.switch)
        if self.relay is not None:
            self.relay_counts = json.loads(self.relay.communicate()[0])
            self.relay = None

    def _has_netem(self):
        probe = ("tc", "-n", self.switch, "qdisc", "add", "dev", "lo", "root", "netem", "delay", "1ms")
        return subprocess.run(probe, capture_output=True).returncode == 0

    def _join_by_bridge(self):
        run("ip", "-n", self.switch, "link", "add", "bridge", "type", "bridge")
        run("ip", "-n", self.switch, "link", "set", "bridge", "up")
        for name in self.names:
            run("ip", "-n", name, "link", "add", "eth0", "type", "veth", "peer", "name", name, "netns", self.switch)
            run("ip", "-n", self.switch, "link", "set", name, "master", "bridge", "up")
            if self.network == "netem":
                run("tc", "-n", name, "qdisc", "add", "dev", "eth0", "root", "netem", "delay", f"{self.delay_ms}ms",
                    "loss", f"{self.loss_percent}%")

    def _join_by_relay(self):
        if not os.access("/dev/net/tun", os.R_OK | os.W_OK):
            raise Unavailable("the kernel has no netem, and there is no /dev/net/tun for a relay")
        # It ends with its input, so also when this process is killed.
        self.relay = subprocess.Popen([sys.executable, "-B", RELAY, str(self.delay_ms), str(self.loss_percent), *self.names],
                                      stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        if self.relay.stdout.readline() != "ready\n":
            raise Unavailable("the relay could make no TAP devices")
        for name in self.names:
            run("ip", "link", "set", name, "netns", name, "name", "eth0")

    def command(self, host, *words):
        """What starts a command on a host, which then says that it is this host."""
        return ["ip", "netns", "exec", host, "unshare", "--uts", "sh", "-c", 'hostname "$0" && exec "$@"', host,
                *map(str, words)]

    def cut(self, host):
        """Nothing comes or goes any more; both ends believe that the other is there."""
        run("ip", "-n", host, "link", "set", "eth0", "down")

    def sent_bytes(self):
        """Of each host, with all headers, until now."""
        sent = {}
        for host in self.names:
            (link,) = json.loads(run("ip", "-n", host, "-s", "-j", "link", "show", "dev", "eth0"))
            sent[host] = link["stats64"]["tx"]["bytes"]
        return sent

    def round_trip_ms(self):
        """From the first host to the second and back: how long a port takes to say that nobody listens there."""
        knock = ("import socket, time\n"
                 "begin = time.monotonic()\n"
                 "try: socket.create_connection(('198.18.0.2', 9), timeout=30)\n"
                 "except ConnectionRefusedError: print(1000 * (time.monotonic() - begin))\n")
        # The least of some, since a lost packet is sent again after a second.
        return min(float(run(*self.command(self.names[0], sys.executable, "-c", knock))) for _ in range(3))
