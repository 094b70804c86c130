"""How long processes wanted a core and had none: lateness that is the machine's, not theirs."""

import os
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from pathlib import Path
from typing import Literal, NamedTuple

Verdict = Literal["in time", "late", "not judged"]
NEVER_EXCUSED = 10
"""times a bound: no machine is so busy that this is not looked into"""
GLANCE_EVERY = 0.01
QUIET = 0.1
"""of the time somebody waits for a core, at most, on a machine that is quiet"""
QUIET_FOR = 0.5
_STEAL = 8
"""the column of /proc/stat: clock ticks in which the host ran somebody else"""


def judge(seconds: float, bound: float, waited: float) -> Verdict:
    """Say whether a bound was kept; what the machine explains alone counts neither way."""
    if seconds <= bound:
        return "in time"
    excused = seconds - bound <= waited and seconds < NEVER_EXCUSED * bound
    return "not judged" if excused else "late"


class Thread(NamedTuple):
    """A thread of a process, by its numbers."""

    pid: int
    tid: int


class Meter:
    """Sums, from its making on, what the processes on a critical path waited for a core.

    Of each process its longest waiting thread counts, because threads wait at the same time;
    to that comes what the host of a virtual machine took. It may excuse lateness, and measures none.
    """

    def __init__(self, path: Callable[[], Iterable[int]], proc: Path = Path("/proc")) -> None:
        self._path = path
        self._proc = proc
        self._pids = list(path())
        self._glanced = time.monotonic()
        self._first = self._last = self._read()
        self._stolen = self._steal()

    def glance(self) -> None:
        """Look, but not again at once: a loop that waits for something may ask each time round."""
        if time.monotonic() - self._glanced >= GLANCE_EVERY:
            self.look()
            self._glanced = time.monotonic()

    def look(self) -> None:
        """Read what cannot be read any more once a process has ended and was waited for."""
        self._pids = list(
            dict.fromkeys([*self._pids, *self._path()])
        )  # one that started meanwhile counts too
        self._last = self._last | self._read()

    @property
    def waited(self) -> float:
        """Seconds, up to now."""
        return sum(self._waits()) + self._taken

    @property
    def longest(self) -> float:
        """Seconds, up to now, of the one process that waited longest."""
        return max(self._waits(), default=0.0) + self._taken

    def _waits(self) -> list[float]:
        """Return seconds by process."""
        self.look()
        longest: dict[int, int] = {}
        for thread, nanoseconds in self._last.items():
            waited = nanoseconds - self._first.get(thread, 0)
            longest[thread.pid] = max(longest.get(thread.pid, 0), waited)
        return [nanoseconds / 1e9 for nanoseconds in longest.values()]

    @property
    def _taken(self) -> float:
        """Seconds that the host took from one core."""
        stolen = max((now - then for then, now in zip(self._stolen, self._steal(), strict=False)), default=0)
        return stolen / os.sysconf("SC_CLK_TCK")

    def _read(self) -> dict[Thread, int]:
        """Return nanoseconds by thread; nothing where the kernel does not count, or a process is gone."""
        found = {}
        for pid in self._pids:
            with suppress(OSError):
                for tid in os.listdir(self._proc / f"{pid}/task"):
                    with suppress(OSError, IndexError, ValueError):
                        text = (self._proc / f"{pid}/task/{tid}/schedstat").read_text()
                        found[Thread(pid, int(tid))] = int(text.split()[1])
        return found

    def _steal(self) -> list[int]:
        """Return the clock ticks that were stolen from each core."""
        try:
            lines = (self._proc / "stat").read_text().splitlines()
        except OSError:
            return []
        cores = [line.split() for line in lines if line.startswith("cpu") and not line.startswith("cpu ")]
        return [int(core[_STEAL]) for core in cores if len(core) > _STEAL]


def await_quiet(patience: float, proc: Path = Path("/proc")) -> bool:
    """Wait until hardly anybody waits for a core; say whether it came to that. Nobody knows: it is quiet."""
    give_up = time.monotonic() + patience
    while _pressure(proc, QUIET_FOR) > QUIET:
        if time.monotonic() > give_up:
            return False
    return True


def _pressure(proc: Path, seconds: float) -> float:
    """Return the share of the next seconds in which somebody waits for a core."""
    before = _stalled(proc)
    time.sleep(seconds)
    return (_stalled(proc) - before) / 1e6 / seconds


def _stalled(proc: Path) -> int:
    """Return the microseconds since the start in which somebody waited for a core."""
    with suppress(OSError, ValueError, IndexError):
        some = (proc / "pressure/cpu").read_text().splitlines()[0]
        return int(some.rpartition("total=")[2])
    return 0
