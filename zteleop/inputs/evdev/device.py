"""One input device of Linux, read as its kernel tells it: linux/input.h, with nothing but the stdlib."""

import os
import sys
from array import array
from collections.abc import Iterator
from struct import Struct, calcsize
from typing import NamedTuple

from zteleop.inputs.evdev.codes import (
    ABS_COUNT,
    EV_ABS,
    EV_KEY,
    EV_SYN,
    KEY_COUNT,
    SYN_DROPPED,
    SYN_REPORT,
)

EVENT = Struct("llHHi")
"""struct input_event: a time in two of the kernel's longs, on 32 bits as on 64"""
ABSINFO = Struct("6i")
LARGEST_READ = 64 * EVENT.size
BLUETOOTH = 5
"""the bus of a device that may be out of reach and yet be there"""


class Event(NamedTuple):
    """One thing that changed."""

    type: int
    code: int
    value: int
    """of a key: 0 let go, 1 pressed, 2 repeated by the kernel"""


RESYNC = Event(EV_SYN, SYN_DROPPED, 0)
"""Events were lost: the device must be asked what is true."""


class Range(NamedTuple):
    """Where an axis is, and how far it goes."""

    value: int
    minimum: int
    maximum: int

    def fraction(self, value: int) -> float:
        """Return where a value lies between the ends, -1 to 1; 0 on an axis without a length."""
        span = self.maximum - self.minimum
        return max(-1.0, min(1.0, 2 * (value - self.minimum) / span - 1)) if span > 0 else 0.0


class EventDevice:
    """An open /dev/input/event*, never blocking; reading one that was unplugged raises OSError."""

    def __init__(self, path: str) -> None:
        self.path = path
        self._dropped = False
        self._fd = os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
        try:
            self.bus = int.from_bytes(self._ask(0x02, 8)[:2], sys.byteorder)
            self.name = self._string(0x06) or path
            self.keys = frozenset(self._bits(0x20 + EV_KEY, KEY_COUNT))
            self.axes = frozenset(self._bits(0x20 + EV_ABS, ABS_COUNT))
        except BaseException:
            self.close()
            raise

    def fileno(self) -> int:
        """Return what turns readable when something changed."""
        return self._fd

    def close(self) -> None:
        """Let go of the device; a grab ends as well."""
        fd, self._fd = self._fd, -1
        if fd >= 0:
            os.close(fd)

    def read(self) -> list[Event]:
        """Return what changed since the last time; RESYNC stands where something was lost."""
        events: list[Event] = []
        while data := self._take():
            events += self._whole(data)
        return events

    def down(self) -> set[int]:
        """Return the keys that are down now; the kernel forgets the key events not read yet."""
        return set(self._bits(0x18, KEY_COUNT))

    def range(self, axis: int) -> Range:
        """Return where an axis is, and its ends."""
        value, minimum, maximum, *_ = ABSINFO.unpack(self._ask(0x40 + axis, ABSINFO.size))
        return Range(value, minimum, maximum)

    def grab(self, exclusive: bool) -> None:
        """Keep what happens here from every other program, or share it again; OSError if another has it."""
        from fcntl import ioctl

        ioctl(self._fd, _request(1, 0x90, calcsize("i")), int(exclusive))

    def _take(self) -> bytes:
        try:
            return os.read(self._fd, LARGEST_READ)
        except BlockingIOError:
            return b""

    def _whole(self, data: bytes) -> Iterator[Event]:
        """Yield the events that are whole: what follows a loss, up to its report, is half of a change."""
        for _, _, kind, code, value in EVENT.iter_unpack(data[: len(data) // EVENT.size * EVENT.size]):
            if (kind, code) == (EV_SYN, SYN_DROPPED):
                self._dropped = True
            elif self._dropped:
                if (kind, code) == (EV_SYN, SYN_REPORT):
                    self._dropped = False
                    yield RESYNC
            elif kind != EV_SYN:
                yield Event(kind, code, value)

    def _string(self, number: int) -> str:
        return self._ask(number, 256).split(b"\0")[0].decode(errors="replace").strip()

    def _bits(self, number: int, count: int) -> Iterator[int]:
        return bits(self._ask(number, count // 8))

    def _ask(self, number: int, size: int) -> bytes:
        from fcntl import ioctl

        answer = array("B", bytes(size))
        ioctl(self._fd, _request(2, number, size), answer)
        return answer.tobytes()


def bits(data: bytes) -> Iterator[int]:
    """Yield the numbers of the bits that are set."""
    for index, byte in enumerate(data):
        for bit in range(8):
            if byte >> bit & 1:
                yield 8 * index + bit


def _request(direction: int, number: int, size: int) -> int:
    return direction << 30 | size << 16 | ord("E") << 8 | number
