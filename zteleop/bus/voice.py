"""Says lines on stderr without ever waiting for whoever should read them.

A pipe that nobody reads, or a terminal that Ctrl-S holds, blocks a write for ever; a loop that keeps a
robot at rest must not wait for either. So a thread writes, and what it cannot write in time is lost.
"""

import os
import sys
import threading
from collections import deque

LINES = 200
"""that may wait; the oldest are lost first"""


class Voice:
    """Writes lines to a file descriptor, from a thread of its own that is started by the first."""

    def __init__(self, file: int) -> None:
        self._file = file
        self._lines: deque[str] = deque(maxlen=LINES)
        self._more = threading.Condition()
        self._writing = False

    def say(self, line: str) -> None:
        with self._more:
            self._lines.append(line)
            if not self._writing:
                self._writing = True
                threading.Thread(target=self._write, daemon=True).start()

    def flush(self, patience: float) -> None:
        """Wait until all is written, at most for some seconds."""
        with self._more:
            self._more.wait_for(lambda: not self._writing, patience)

    def _write(self) -> None:
        while line := self._next():
            try:
                os.write(self._file, line.encode(errors="replace") + b"\n")
            except OSError:
                continue  # nobody will ever read it

    def _next(self) -> str | None:
        with self._more:
            if self._lines:
                return self._lines.popleft() or " "
            self._writing = False
            self._more.notify_all()
            return None


_voice = Voice(2)


def say(line: str) -> None:
    """Say a line on stderr, soon."""
    _voice.say(line)


def flush() -> None:
    """Let what was said be read, where somebody reads it."""
    sys.stderr.flush()
    _voice.flush(0.2)
