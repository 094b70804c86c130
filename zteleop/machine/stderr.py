"""Says lines on stderr without ever waiting for whoever should read them.

A pipe that nobody reads, or a terminal that Ctrl-S holds, blocks a write for ever; a loop that keeps a
robot at rest must not wait for either. So a thread writes, and what it cannot write in time is lost.
"""

import os
import sys
import threading
import time
from collections import deque
from contextlib import suppress
from queue import SimpleQueue

from zteleop.machine import signals

LINES = 200
"""that may wait; the oldest are lost first"""
_GLANCE = 0.001


class LineWriter:
    """Writes lines to a file descriptor, from one thread of its own.

    Whoever speaks may step a robot at real-time priority, and the thread that writes is an ordinary one: so
    speaking takes no lock, and starts no thread but once. Either would be a priority inversion, which lasts
    for as long as the machine is busy with something else.
    """

    def __init__(self, file: int) -> None:
        self._file = file
        self._lines: deque[str] = deque(maxlen=LINES)
        self._bell: SimpleQueue[None] = SimpleQueue()
        self._thread: threading.Thread | None = None
        self._writing = False

    def tell(self, line: str) -> None:
        self._lines.append(line)
        if self._bell.empty():  # else it has yet to come for this line as well
            self._bell.put(None)
        if self._thread is None:
            self._thread = threading.Thread(target=self._write, name="writer", daemon=True)
            signals.start(self._thread)

    def flush(self, patience: float) -> None:
        """Wait until all is written, at most for some seconds."""
        give_up = time.monotonic() + patience
        while (self._lines or self._writing) and time.monotonic() < give_up:
            time.sleep(_GLANCE)

    def _write(self) -> None:
        _stand_back()
        while True:
            self._bell.get()
            self._writing = True
            while self._lines:
                line = self._lines.popleft() or " "
                try:
                    os.write(self._file, line.encode(errors="replace") + b"\n")
                except OSError:
                    continue  # nobody will ever read it
            self._writing = False


def _stand_back() -> None:
    """Be an ordinary thread, even if the one that spoke first runs before those, and this inherited it."""
    if sys.platform == "linux":
        with suppress(OSError):
            os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


_PRIORITIES = {"debug": 7, "info": 6, "warning": 4, "error": 3, "fatal": 2}
_writer = LineWriter(2)


def in_journal() -> bool:
    """Say whether stderr goes to systemd's journal, by what it says of it and what the file is."""
    with suppress(OSError):
        file = os.fstat(2)
        return os.environ.get("JOURNAL_STREAM") == f"{file.st_dev}:{file.st_ino}"
    return False


def with_priority(line: str) -> str:
    """Return a line of a log as the journal reads it, which takes its level from the front (sd-daemon(3))."""
    word = (line.split(": ", 2)[1:2] or [""])[0]
    return f"<{_PRIORITIES[word]}>{line}" if word in _PRIORITIES else line


def tell(line: str) -> None:
    """Say a line on stderr, soon."""
    _writer.tell(with_priority(line) if _in_journal else line)


_in_journal = in_journal()


def flush() -> None:
    """Let what was said be read, where somebody reads it."""
    sys.stderr.flush()
    _writer.flush(0.2)
