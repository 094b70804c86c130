"""What can go wrong on a simulated bus, put in through the chip's file by whoever can write it.

Behind the registers, little-endian: counters, of which each transfer counts one down, and then how often
a transfer fails all the time, and how long each takes.
"""

import errno
import fcntl
import os
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from struct import Struct
from typing import NamedTuple, Self

from zteleop.drivers.chip import POWER_UP, SIZE
from zteleop.drivers.chip_file import open_file
from zteleop.drivers.i2c import EREMOTEIO, Block
from zteleop.errors import ConfigError


class Area(NamedTuple):
    """The faults to come, as they stand in the file."""

    nack: int = 0
    tear: int = 0
    hang: int = 0
    after_bytes: int = 0
    ms: int = 0
    every: int = 0
    percent: int = 0
    state: int = 0
    """how many transfers `every` has seen, or the last number of `percent`'s generator"""
    slow_ms: int = 0


LAYOUT = Struct("<IIIHHHHIHxx")
LIMITS = Area(2**32 - 1, 2**32 - 1, 2**32 - 1, 2**16 - 1, 2**16 - 1, 2**16 - 1, 100, 2**32 - 1, 1000)


class Fault(NamedTuple):
    """What one transfer meets."""

    number: int
    """errno"""
    after_bytes: int = 0
    """Data bytes that still get through."""
    ms: int = 0
    """How long it blocks before."""


class Faults:
    """Puts faults into the chip of a file, also while drivers of other processes use it.

    Transfers to the chip's own address meet them, one each: a hang before a nack before a tear before
    what fails now and then.
    """

    def __init__(self, path: str) -> None:
        """Open the chip; raises DeviceError when its file cannot be opened."""
        self._file = open_file(path)

    def nack(self, transfers: int) -> None:
        """Let that many reads and writes find nobody at the address (EREMOTEIO)."""
        self._put(nack=transfers)

    def tear(self, transfers: int, after_bytes: int) -> None:
        """Let that many writes end after so many data bytes: these are latched, then EREMOTEIO.

        A write of no more bytes than that passes whole, and does not count.
        """
        self._put(tear=transfers, after_bytes=after_bytes)

    def hang(self, transfers: int, ms: int) -> None:
        """Let that many reads and writes block for so many milliseconds and then fail (ETIMEDOUT)."""
        self._put(hang=transfers, ms=ms)

    def every(self, nth: int) -> None:
        """Let every n-th read or write find nobody at the address, until it is 0."""
        self._put(every=nth, percent=0, state=0)

    def at_random(self, percent: int) -> None:
        """Let that many of a hundred reads and writes find nobody at the address, until it is 0."""
        self._put(every=0, percent=percent, state=1)

    def slow(self, ms: int) -> None:
        """Let every read or write take so many milliseconds more, one after the other, until it is 0."""
        self._put(slow_ms=ms)

    def brown_out(self) -> None:
        """Let the supply dip: the registers are those of power-up, and writes go on to succeed."""
        os.pwrite(self._file, POWER_UP, 0)

    def clear(self) -> None:
        """Take out every fault; what the supply's dip did to the registers stays."""
        self._put(**Area()._asdict())

    def pending(self) -> Area:
        """Return the faults that no transfer has met yet."""
        return _read(self._file)

    def close(self) -> None:
        """Let go of the file, faults and all."""
        os.close(self._file)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.clear()
        self.close()

    def _put(self, **figures: int) -> None:
        for name, figure in figures.items():
            limit = getattr(LIMITS, name)
            if not 0 <= figure <= limit:
                raise ConfigError(f"the fault's {name} must be within 0..{limit}, found {figure}")
        with _locked(self._file):
            _write(self._file, _read(self._file)._replace(**figures))


def next_fault(path: str, length: int = 0) -> Fault | None:
    """Count down and return what a transfer of `length` bytes to write meets, if anything."""
    file = os.open(path, os.O_RDWR)  # opened anew: a lock belongs to an opening, and parents share theirs
    try:
        with _locked(file):
            left, fault = _meet(_read(file), length)
            _write(file, left)
            time.sleep(left.slow_ms / 1000)  # with the lock: a bus does one transfer at a time
    finally:
        os.close(file)
    return fault


def cut(blocks: Sequence[Block], after_bytes: int) -> list[Block]:
    """Return what gets through of a transaction that ends after so many data bytes."""
    through = []
    for register, data in blocks:
        through.append((register, data[:after_bytes]))
        after_bytes = max(0, after_bytes - len(data))
    return through


def _meet(area: Area, length: int) -> tuple[Area, Fault | None]:
    if area.hang:
        return area._replace(hang=area.hang - 1), Fault(errno.ETIMEDOUT, ms=area.ms)
    if area.nack:
        return area._replace(nack=area.nack - 1), Fault(EREMOTEIO)
    if area.tear and length > area.after_bytes:
        return area._replace(tear=area.tear - 1), Fault(EREMOTEIO, area.after_bytes)
    if area.every:
        seen = (area.state + 1) % area.every
        return area._replace(state=seen), None if seen else Fault(EREMOTEIO)
    if area.percent:
        number = (area.state * 1664525 + 1013904223) % 2**32
        fails = (number >> 16) % 100 < area.percent
        return area._replace(state=number), Fault(EREMOTEIO) if fails else None
    return area, None


@contextmanager
def _locked(file: int) -> Iterator[None]:
    """Keep the other processes of the chip off: a count written late must not undo `clear`."""
    fcntl.flock(file, fcntl.LOCK_EX)
    try:
        yield
    finally:
        fcntl.flock(file, fcntl.LOCK_UN)


def _read(file: int) -> Area:
    return Area(*LAYOUT.unpack(os.pread(file, LAYOUT.size, SIZE)))


def _write(file: int, area: Area) -> None:
    os.pwrite(file, LAYOUT.pack(*area), SIZE)
