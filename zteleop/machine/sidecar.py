"""The black box as the watchdog sees it: a process that is started, and whose death never matters."""

import os
import subprocess
from collections.abc import Callable, Sequence
from contextlib import suppress

from zteleop.machine.signals import ending

LAST_WORD = b"end\n"
"""The watchdog's last word; without it, it did not end but broke down."""
DELAY = 1.0
"""s after the actuator's first step; it drives first"""
STARTS, STEADY = 5, 600.0
"""How often it is started in a row, and the s after which an end is not in a row with the one before."""
ENDS_WITHIN = 1.0
"""s for it to write what is due when the robot ends"""


class Recorder:
    """Runs `command` with settings on its stdin, which stays open for as long as this process lives."""

    def __init__(self, command: Sequence[str], settings: bytes, warn: Callable[[str], object]) -> None:
        self._command = command
        self._settings = settings
        self._warn = warn
        self._process: subprocess.Popen[bytes] | None = None
        self._due: float | None = None
        self._starts = 0
        self._started = float("-inf")

    def tend(self, now: float) -> None:
        """Start it when it is time, and again a few times when it has ended; `now` in seconds."""
        if self._process and self._process.poll() is None:
            return
        if self._due is None:
            self._due = self._plan(now)
            if self._process and self._due < float("inf"):
                how = ending(self._process.returncode)
                self._warn(f"the black box is gone: it ended{how}; another starts in {self._due - now:g} s")
        elif now >= self._due:
            self._due, self._started = None, now
            self._start()

    def end(self) -> None:
        """Say farewell, and wait a moment for what it may have to write."""
        if self._process is None or self._process.stdin is None:
            return
        with suppress(OSError), self._process.stdin as ear:
            ear.write(LAST_WORD)
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(ENDS_WITHIN)

    def _plan(self, now: float) -> float:
        """Return when it starts: later each time, and never once it has ended too often."""
        if now - self._started > STEADY:
            self._starts = 0
        if self._starts == STARTS:
            self._warn(f"the black box has ended {STARTS} times in a row, and is not started again")
            return float("inf")
        return now + DELAY * 2.0**self._starts

    def _start(self) -> None:
        self._starts += 1
        if self._process and self._process.stdin:
            self._process.stdin.close()
        try:
            self._process = subprocess.Popen(
                self._command, stdin=subprocess.PIPE, bufsize=0, start_new_session=True
            )
            assert self._process.stdin
            os.set_blocking(self._process.stdin.fileno(), False)  # nothing may wait for it
            self._process.stdin.write(self._settings + b"\n")
        except OSError as error:
            self._warn(f"there is no black box: {error.strerror}")
