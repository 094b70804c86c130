"""The actuator as the watchdog sees it: a process that is started, heard, killed, and started again."""

import os
import subprocess
from collections.abc import Sequence
from contextlib import suppress

import msgspec

from zteleop.control.standing import Standing
from zteleop.machine import link
from zteleop.machine.backoff import BackOff
from zteleop.machine.link import Report, WatchdogEnd

DIES_WITHIN = 0.1
"""s for a killed process to go; one that is stuck in the kernel takes longer."""


class Child:
    """One process at a time, run by `command`: two lines on stdin, the files in `shared` inherited.

    The first line is the settings; the second says where the actuator stood whose place it takes, or null.
    """

    def __init__(self, command: Sequence[str], settings: bytes, shared: Sequence[int] = ()) -> None:
        self._command = command
        self._settings = settings
        self._shared = shared
        self._process: subprocess.Popen[bytes] | None = None
        self.link: WatchdogEnd | None = None
        self._life: int | None = None
        """a pipe that nobody writes to, whose other end the process alone holds"""
        self.newest: Report | None = None
        self.stopped_since: float | None = None
        """When it first said that it rests for a stop, which it has said ever since."""
        self.started = float("-inf")
        self.starts = 0
        self._backoff = BackOff()

    @property
    def ready(self) -> bool:
        """It has reported a step."""
        return self.newest is not None

    def start(self, now: float, standing: Standing | None = None) -> None:
        """Start the process; nobody else holds an end of its link."""
        self.link, theirs = link.pair()
        self._life, life = os.pipe()
        with theirs, open(life, "wb"):
            command = [*self._command, str(theirs.fileno())]
            # In a session of its own, so that no key of a terminal ends or stops both processes at once.
            self._process = subprocess.Popen(
                command,
                stdin=subprocess.PIPE,
                pass_fds=[theirs.fileno(), life, *self._shared],
                start_new_session=True,
            )
        assert self._process.stdin
        with suppress(BrokenPipeError), self._process.stdin as settings:
            settings.write(self._settings + b"\n" + msgspec.json.encode(standing))
        self.newest = None
        self.stopped_since = None
        self.started = now
        self.starts += 1

    def fileno(self) -> int:
        """Return what turns readable when it ends, and not with each report.

        A pidfd would as well, but some 80 ms later at times: when its memory is given back.
        """
        assert self._life is not None
        return self._life

    def hear(self, now: float) -> None:
        """Take in its reports; raises EOFError when it is gone."""
        if self.link and (report := self.link.read()):
            self.newest = report
            self.stopped_since = (self.stopped_since or now) if report.stopped else None

    def silence(self, now: float) -> float:
        """Return the seconds since its last step, or since it was started."""
        last = self.newest.stepped if self.newest else self.started
        return now - (last if last <= now else self.started)  # a step yet to come, or at no time, is none

    def ask_to_end(self) -> None:
        if self._process:
            self._process.terminate()

    @property
    def gone(self) -> bool:
        """It has ended; until then it may write again."""
        return self._process is None or self._process.poll() is not None

    def end(self, patience: float) -> int | None:
        """Wait for its end, then kill it; return its exit code, None while it is not gone even so."""
        if self._process is None:
            return None
        for wait in (patience, DIES_WITHIN):
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(wait)
                break
            self._process.kill()
        if self.link:
            self.link.close()
            self.link = None
        if self._life is not None:
            os.close(self._life)
            self._life = None
        return self._process.returncode

    def pause(self, now: float) -> float:
        """Return for how long to wait before the next start."""
        return self._backoff.pause(now - self.started)
