"""From a typed publish to a typed handler in another process, beside raw zenoh, ZeroMQ and ROS 1."""

import os
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import IO

from figures import is_quick, median, p99, print_table, verdict
from processes import free_endpoint, running

PEERS = str(Path(__file__).with_name("peers.py"))
WAYS = {
    "zteleop": "zteleop: publish -> handler in node.spin()",
    "raw": "raw zenoh: main thread in recv()",
    "raw_handed": "raw zenoh, woken: a thread in recv() wakes the main thread",
    "zeromq": "pyzmq: bytes, main thread in recv()",
    "rospy": "rospy: TwistStamped, callback",
}
MODULES = {"zeromq": "zmq", "rospy": "rospy, geometry_msgs.msg, rosmaster"}
PYTHONS = (sys.executable, "/usr/bin/python3", os.environ.get("PEER_PYTHON", "/nonexistent"))
"""Where peers may be; Debian has python3-rospy, python3-rosmaster and python3-geometry-msgs."""
TARGET = 1.25


class Way:
    """A publisher and a subscriber that wait for the next block."""

    def __init__(self, name: str, python: str, stack: ExitStack) -> None:
        self.samples: list[float] = []
        command, endpoint = [python, PEERS, name], free_endpoint()
        self._publisher = stack.enter_context(
            running([*command, "publish", endpoint], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        )
        assert self._publisher.stdout
        if self._publisher.stdout.readline() != "ready\n":
            raise SystemExit(f"no {name} publisher: {' '.join(command)} publish {endpoint}")
        self._heard: IO[str] = stack.enter_context(tempfile.TemporaryFile("w+"))  # noqa: SIM115
        stack.enter_context(running([*command, "subscribe", endpoint], stdout=self._heard))

    def say(self, count: int) -> None:
        """Say a block of messages, and take down how long each took."""
        assert self._publisher.stdin
        start = self._heard.seek(0, 2)
        self._publisher.stdin.write(f"{count}\n")
        self._publisher.stdin.flush()
        time.sleep(count / 100 + 0.2)
        self._heard.seek(start)
        self.samples += [float(line) for line in self._heard]


def find_python(name: str) -> str | None:
    """Return a Python that can import what a way needs."""
    if name not in MODULES:
        return sys.executable
    for python in PYTHONS:
        if Path(python).exists():
            tried = subprocess.run([python, "-c", f"import {MODULES[name]}"], capture_output=True)
            if tried.returncode == 0:
                return python
    print(f"{name}: skipped, no Python here imports {MODULES[name]}")
    return None


def time_ways(rounds: int, count: int) -> dict[str, list[float]]:
    """Return the us of each message by each way that there is here, taken in turn."""
    with ExitStack() as stack:
        ways = {name: Way(name, python, stack) for name in WAYS if (python := find_python(name))}
        time.sleep(2)
        for way in ways.values():
            way.say(20)
            way.samples.clear()
        for _ in range(rounds):
            for way in ways.values():
                way.say(count)
    return {name: way.samples for name, way in ways.items()}


def main() -> None:
    quick = is_quick(__doc__)
    rounds, count = (1, 100) if quick else (12, 200)
    ways, rows = time_ways(rounds, count), []
    for name, samples in ways.items():
        ratio, woken = (median(samples) / median(ways[peer]) for peer in ("raw", "raw_handed"))
        target = verdict(ratio, TARGET, "x raw") if name == "zteleop" else ""
        figures = (median(samples), p99(samples), len(samples), ratio, woken)
        rows.append((WAYS[name], *figures, target))
    way = "way, 100 Hz, TwistStamped or as many bytes"
    head = [way, "p50 us", "p99 us", "heard", "of raw", "of raw, woken", "target"]
    print_table(f"publish to handler, {rounds * count} messages each, in turn", head, rows)


if __name__ == "__main__":
    main()
