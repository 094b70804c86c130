"""Several programs that are started together, started again when they fail, and ended in order."""

import ctypes
import os
import select
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from typing import NamedTuple

from zteleop.machine.backoff import BackOff

ENDS_WITHIN = 5.0
"""s for a program to end by itself once it is told to"""
AT_ONCE, LONGEST = 65536, 4096
"""bytes that are read at once, and of a line that has no end: it is told in pieces"""
USAGE = 2
"""the exit code of a program that was called wrongly, which no second start mends"""
LOOK_EVERY = 0.1


if sys.platform == "linux":
    LIBC = ctypes.CDLL(None)
    PR_SET_PDEATHSIG = 1  # <linux/prctl.h>

    def _end_with_starter() -> None:
        """Have the kernel end this program when who started it dies, however that was."""
        LIBC.prctl(PR_SET_PDEATHSIG, signal.SIGTERM)


class Program(NamedTuple):
    """What is started under a name."""

    command: Sequence[str]
    ends_first: bool = False
    """it moves something: it is ended, and has ended, before any other is told to"""


class Launch:
    """Runs programs; what each prints goes to `tell` line by line, with its name.

    Each has a session of its own, so that no key of a terminal ends one before its turn, and a standard input
    that ends with this process.
    """

    def __init__(self, programs: Mapping[str, Program], tell: Callable[[str, str], object]) -> None:
        self._tell = tell
        self._ending = False
        self._running = [Running(name, program, self._pass_on) for name, program in programs.items()]

    def run(self) -> int:
        """Run until every program is done; return the first exit code that told of a failure, else 0."""
        try:
            while alive := [one for one in self._running if not one.done]:
                now = time.monotonic()
                for one in alive:
                    one.tend(now)
                files = [one.file for one in alive if one.file is not None]
                select.select(files, [], [], LOOK_EVERY)
        finally:
            self._end()
        failures = sorted((one.failed_at, one.code) for one in self._running if one.code)
        return failures[0][1] if failures else 0

    def _pass_on(self, name: str, line: str) -> None:
        """Tell a line; whoever heard may be gone, which ends all of them, and holds up no end."""
        try:
            self._tell(name, line)
        except OSError:
            if not self._ending:
                raise

    def _end(self) -> None:
        """End all of them: first what moves something, then the others, the last started first."""
        self._ending = True
        for first in (True, False):
            those = [one for one in reversed(self._running) if one.program.ends_first is first]
            for one in those:
                one.ask_to_end()
            give_up = time.monotonic() + ENDS_WITHIN
            for one in those:
                one.end(give_up)


class Running:
    """One program, as often as it is started; times are monotonic, in s."""

    def __init__(self, name: str, program: Program, tell: Callable[[str, str], object]) -> None:
        self.name = name
        self.program = program
        self.done = False
        """It is not started again."""
        self.code = 0
        """The exit code with which it failed for good."""
        self.failed_at = float("inf")
        self._tell = tell
        self._process: subprocess.Popen[bytes] | None = None
        self._back_off = BackOff()
        self._started = 0.0
        self._due = float("-inf")
        self._rest = b""

    @property
    def file(self) -> int | None:
        """What turns readable when it says something."""
        return self._process.stdout.fileno() if self._process and self._process.stdout else None

    def tend(self, now: float) -> None:
        """Pass on what it said; start it when it is time, and again when it has failed."""
        if self._process is None:
            if now >= self._due:
                self._start(now)
            return
        self._read()
        if (code := self._process.poll()) is not None:
            self._close(self._process)
            self._ended(code, now)

    def ask_to_end(self) -> None:
        if self._process and self._process.poll() is None:
            with suppress(OSError):
                self._process.send_signal(signal.SIGTERM)

    def end(self, give_up: float) -> None:
        """Wait until it has ended, pass on its last words, and kill what does not end in time."""
        if not (process := self._process):
            return
        while process.poll() is None and time.monotonic() < give_up:
            time.sleep(LOOK_EVERY / 10)
            self._read()
        if process.poll() is None:
            self._tell(self.name, f"did not end within {ENDS_WITHIN:g} s, and is killed")
            with suppress(OSError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        self._read()
        self._close(process)

    def _start(self, now: float) -> None:
        self._started = now
        try:
            self._process = subprocess.Popen(
                self.program.command,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                start_new_session=True,
                preexec_fn=_end_with_starter if sys.platform == "linux" else None,
            )
        except OSError as error:
            self._fail(127, f"cannot be started: {error.strerror}", now)
            return
        assert self._process.stdout
        os.set_blocking(self._process.stdout.fileno(), False)

    def _ended(self, code: int, now: float) -> None:
        if code == 0:
            self.done = True
            self._tell(self.name, "is done")
        elif code == USAGE:
            how = f"ended with exit code {USAGE}: it was called wrongly, or is not there"
            self._fail(code, f"{how}; it is not started again", now)
        else:
            pause = self._back_off.pause(now - self._started)
            self._due = now + pause
            how = f"exit code {code}" if code > 0 else f"signal {-code}"
            self._tell(self.name, f"ended with {how}; starts again in {pause:g} s")

    def _fail(self, code: int, words: str, now: float) -> None:
        self.done, self.code, self.failed_at = True, code, now
        self._tell(self.name, words)

    def _read(self) -> None:
        """Pass on the lines that are there, some at a time: the others wait meanwhile."""
        file, data = self.file, b""
        with suppress(BlockingIOError):
            data = os.read(file, AT_ONCE) if file is not None else b""
        *lines, self._rest = (self._rest + data).split(b"\n")
        if len(self._rest) > LONGEST:
            lines, self._rest = [*lines, self._rest], b""
        for line in lines:
            self._tell(self.name, line.decode(errors="replace").rstrip("\r"))

    def _close(self, process: "subprocess.Popen[bytes]") -> None:
        """Tell what was said without an end of line, and give the pipes back."""
        self._process = None
        if self._rest:
            self._tell(self.name, self._rest.decode(errors="replace"))
            self._rest = b""
        for pipe in (process.stdin, process.stdout):
            if pipe:
                pipe.close()
