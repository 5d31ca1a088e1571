"""A network switch with delay and loss, of TAP devices: what `tc netem` does, for kernels that have it not.

    tap_relay.py DELAY_MS LOSS_PERCENT DEVICE...

makes the devices and says "ready"; whoever started it moves each into the namespace of its host. A frame waits DELAY_MS
and is lost with LOSS_PERCENT on its way from one device to another, as netem at each host's way out would have it, so
that an answer takes twice as long. It ends with its standard input, by a line of JSON that says what has passed.
"""

import collections
import errno
import fcntl
import json
import os
import random
import select
import struct
import sys
import time

# <linux/if_tun.h>
TUNSETIFF = 0x400454CA
IFF_TAP = 0x0002
IFF_NO_PI = 0x1000

LONGEST_FRAME = 65536
FRAMES_AT_ONCE = 64  # of one device, before the others have their turn


def open_tap(name):
    port = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(port, TUNSETIFF, struct.pack("16sH22x", name.encode(), IFF_TAP | IFF_NO_PI))
    return port


class Switch:
    def __init__(self, ports, delay, loss, seed=1):
        self.ports, self.delay, self.loss = ports, delay, loss
        self.random = random.Random(seed)
        self.port_of = {}  # hardware address -> port on which it was heard
        self.waiting = collections.deque()  # (when due, port it came from, frame); all wait alike, so this is in order
        self.counts = {"frames": 0, "bytes": 0, "lost": 0}

    def receive(self, port):
        try:
            for _ in range(FRAMES_AT_ONCE):
                frame = os.read(port, LONGEST_FRAME)
                self.port_of[frame[6:12]] = port
                self.counts["frames"] += 1
                self.counts["bytes"] += len(frame)
                if self.random.random() < self.loss:
                    self.counts["lost"] += 1
                else:
                    self.waiting.append((time.monotonic() + self.delay, port, frame))
        except BlockingIOError:
            pass
        except OSError as error:
            if error.errno not in (errno.EBADFD, errno.EIO):
                raise
            self.ports.remove(port)  # its namespace is gone

    def forward(self, source, frame):
        known = self.port_of.get(frame[:6])
        for port in self.ports if known is None else [known]:
            if port == source:
                continue
            try:
                os.write(port, frame)
            except OSError:
                pass  # a device that is down, or gone, or full: lost, as on a real network

    def run(self):
        while True:
            left = max(0.0, self.waiting[0][0] - time.monotonic()) if self.waiting else None
            ready = select.select([sys.stdin, *self.ports], [], [], left)[0]
            if sys.stdin in ready:
                return
            for port in ready:
                self.receive(port)
            while self.waiting and self.waiting[0][0] <= time.monotonic():
                _, source, frame = self.waiting.popleft()
                self.forward(source, frame)


def main():
    delay_ms, loss_percent, *names = sys.argv[1:]
    switch = Switch([open_tap(name) for name in names], float(delay_ms) / 1000, float(loss_percent) / 100)
    print("ready", flush=True)
    switch.run()
    print(json.dumps(switch.counts))


if __name__ == "__main__":
    main()
