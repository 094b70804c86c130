"""A cable that can be disturbed: carries frames between TAP devices in two network namespaces.

python -m faults.link.emulator NAMESPACE NAMESPACE [--seed N]

It says `ready` once both devices stand. Each line of its standard input is an order in JSON, such as
{"forth": {"delay": 0.1}, "back": {"dead": true}}, which it answers with `set`; the end of its input ends it.
"""

import argparse
import ctypes
import json
import os
import select
import sys
import time
from collections import deque
from collections.abc import Iterator
from contextlib import suppress
from fcntl import ioctl
from heapq import heappop, heappush
from itertools import count
from random import Random
from struct import pack
from typing import Any, NamedTuple

DEVICE = "cable"
_CLONE_NEWNET = 0x40000000
_TUNSETIFF, _IFF_TAP, _IFF_NO_PI = 0x400454CA, 0x0002, 0x1000
_LARGEST_FRAME = 65536
_PIECE = 64
"""frames taken of one side before the other has its turn"""
_NICE = -10
"""so that whatever else runs does not delay the frames"""


class Way(NamedTuple):
    """What happens to the frames of one direction."""

    delay: float = 0.0
    """s"""
    jitter: float = 0.0
    """s more at most, evenly at random; the order stays"""
    loss: float = 0.0
    """share of the frames"""
    overtaking: float = 0.0
    """share of the frames that are not delayed, and so arrive before those in front of them"""
    rate: float | None = None
    """bit/s"""
    queue: int = 1000
    """frames that wait for their turn; where the rate is not enough, further ones are lost"""
    dead: bool = False


class Line:
    """The frames of one direction that are on their way."""

    def __init__(self, random: Random) -> None:
        self.way = Way()
        self._random = random
        self._flying: list[tuple[float, int, bytes]] = []
        self._numbers = count()
        self._waiting: deque[float] = deque()
        """when each frame in the queue has left it"""
        self._arrives = self._leaves = 0.0

    @property
    def due(self) -> float:
        """When the next frame arrives."""
        return self._flying[0][0] if self._flying else float("inf")

    def put(self, frame: bytes, now: float) -> None:
        """Send a frame on its way, or lose it."""
        while self._waiting and self._waiting[0] <= now:
            self._waiting.popleft()
        lost = self.way.dead or self._random.random() < self.way.loss
        if not lost and len(self._waiting) < self.way.queue:
            heappush(self._flying, (self._arrival(len(frame), now), next(self._numbers), frame))

    def take(self, now: float) -> Iterator[bytes]:
        """Yield the frames that have arrived."""
        while self._flying and self._flying[0][0] <= now:
            yield heappop(self._flying)[2]

    def _arrival(self, size: int, now: float) -> float:
        """Return when a frame of that size arrives."""
        way = self.way
        self._leaves = max(now, self._leaves) + (8 * size / way.rate if way.rate else 0.0)
        self._waiting.append(self._leaves)
        if self._random.random() < way.overtaking:
            return self._leaves
        late = way.delay + way.jitter * self._random.random()
        self._arrives = max(self._arrives, self._leaves + late)
        return self._arrives


class Cable:
    """Two devices, and the lines from each to the other."""

    def __init__(self, devices: tuple[int, int], seed: int) -> None:
        random = Random(seed)
        self.forth, self.back = Line(random), Line(random)
        here, there = devices
        self._ends = {here: (self.forth, there), there: (self.back, here)}

    def carry(self, orders: int) -> None:
        """Carry frames until an order, or the end of all orders, can be read."""
        while True:
            due = min(self.forth.due, self.back.due)
            patience = None if due == float("inf") else max(0.0, due - time.monotonic())
            ready = select.select([*self._ends, orders], [], [], patience)[0]
            for device in ready:
                if device != orders:
                    self._take_in(device)
            self._hand_out()
            if orders in ready:
                return

    def _take_in(self, device: int) -> None:
        line, _ = self._ends[device]
        with suppress(BlockingIOError):
            for _ in range(_PIECE):
                line.put(os.read(device, _LARGEST_FRAME), time.monotonic())

    def _hand_out(self) -> None:
        now = time.monotonic()
        for line, other in self._ends.values():
            for frame in line.take(now):
                with suppress(OSError):  # that device is down, or full
                    os.write(other, frame)


def enter(namespace: str) -> None:
    """Move this thread into a network namespace; raises OSError when there is none, or no permission."""
    libc = ctypes.CDLL(None, use_errno=True)  # os.setns came with Python 3.12
    with open(f"/run/netns/{namespace}") as file:
        if libc.setns(file.fileno(), _CLONE_NEWNET):
            raise OSError(ctypes.get_errno(), f"cannot enter the network namespace {namespace}")


def open_device(namespace: str) -> int:
    """Make a TAP device in a namespace, which this thread enters; raises OSError when that cannot be."""
    enter(namespace)
    device = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    ioctl(device, _TUNSETIFF, pack("16sH22x", DEVICE.encode(), _IFF_TAP | _IFF_NO_PI))
    return device


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("namespaces", nargs=2)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    here, there = (open_device(namespace) for namespace in options.namespaces)
    with suppress(PermissionError):  # an instrument must not wait for what it measures
        os.nice(_NICE)
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))
    cable = Cable((here, there), options.seed)
    _answer("ready")
    while True:
        cable.carry(sys.stdin.fileno())
        line = sys.stdin.readline()
        if not line:
            return
        _obey(cable, json.loads(line))
        _answer("set")


def _obey(cable: Cable, order: dict[str, Any]) -> None:
    cable.forth.way, cable.back.way = Way(**order["forth"]), Way(**order["back"])


def _answer(word: str) -> None:
    sys.stdout.write(f"{word}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
