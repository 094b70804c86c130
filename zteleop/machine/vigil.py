"""What a door is ended for: it does not open, falls silent, or grows."""

import os
from contextlib import suppress
from pathlib import Path

from zteleop.control.deadlines import DOOR_SILENCE, DOOR_START, LONGEST_OPENING

LARGEST = 192 * 2**20
"""bytes of memory; strangers fill it, and the robot's own processes need the rest of the machine"""
WEIGH_EVERY = 0.5
"""s"""


class Vigil:
    """Watches one process after the other; times in s."""

    def __init__(self) -> None:
        self.started = float("-inf")
        self._heard = float("-inf")
        """When it last said that it works."""
        self._weighed = float("-inf")
        self._patience = DOOR_START
        """How long it may take to open."""

    def begin(self, now: float) -> None:
        """Watch the next one, which starts now."""
        self.started = now

    def hear(self, now: float, first: bool) -> None:
        """Take in its word; the first says that it is open, and the doubled time for opening is reset."""
        self._heard = now
        if first:
            self._patience = DOOR_START

    def judge(self, pid: int, is_open: bool, now: float) -> str:
        """Return what the process `pid` is to be ended for; nothing while it is as it must be.

        One that did not open in time leaves the next twice as long.
        """
        if not is_open:
            return self._judge_start(now)
        if now - self._heard > DOOR_SILENCE:
            return f"it was silent for {now - self._heard:.1f} s"
        if now - self._weighed > WEIGH_EVERY:
            self._weighed = now
            weight = weigh(pid)
            if weight > LARGEST:
                return f"it had grown to {weight // 2**20} MB, of {LARGEST // 2**20}"
        return ""

    def _judge_start(self, now: float) -> str:
        if now - self.started <= self._patience:
            return ""
        had = self._patience
        self._patience = min(2 * had, LONGEST_OPENING)
        return f"it did not open within {had:g} s of its start, and the next has {self._patience:g} s"


def weigh(pid: int) -> int:
    """Return the bytes of memory that a process holds by itself; nothing where the system does not tell."""
    with suppress(OSError, ValueError, IndexError):
        pages = Path(f"/proc/{pid}/statm").read_text().split()
        return (int(pages[1]) - int(pages[2])) * os.sysconf("SC_PAGE_SIZE")
    return 0
