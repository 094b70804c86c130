"""Lines on a disk that may hang, fill up or be pulled: a thread of its own, two files, bounded.

Not `logging`: the end of its listener joins its thread, and its exit handler waits for the handler's lock,
both for as long as the disk hangs.
"""

import errno
import os
import threading
from collections import deque
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, BinaryIO, NamedTuple

import msgspec

from zteleop.bus import clock
from zteleop.bus.escape import printable
from zteleop.machine import realtime, signals
from zteleop.messages import Time

SIZE = 1_000_000
"""bytes of a file; there are two, the older ends in .old"""
WAITING = 1000
"""lines that may wait for the disk; what does not fit is lost and counted"""
GATHER = 0.1
"""s that lines wait for others, so that a flood of them is one write"""
SYNC = 1.0
"""s after which a line outlives a pulled battery"""
FLUSH = 1.0
"""s that the end of a process may wait for its disk"""
LONG = 500
"""characters of a text"""


class Entry(NamedTuple):
    time: Time
    at: float
    event: str
    values: dict[str, Any]

    def encode(self) -> bytes:
        """Return the line as JSON; what JSON cannot say, and long or unprintable text, is made harmless."""
        second = datetime.fromtimestamp(self.time.sec, UTC).strftime("%Y-%m-%dT%H:%M:%S")
        when = {"time": f"{second}.{self.time.nanosec // 1_000_000:03}Z", "at": round(self.at, 3)}
        values = {name: _harmless(value) for name, value in self.values.items()}
        return msgspec.json.encode(when | {"event": self.event} | values, enc_hook=str) + b"\n"


class JournalFile:
    """Appends lines; `trouble` says in words what the disk last refused."""

    def __init__(self, path: Path) -> None:
        self.trouble = ""
        self._path = path
        self._size = 0
        self._synced = clock.now()
        self._file: BinaryIO | None = None
        self._waiting: deque[Entry] = deque()
        # each is counted by one thread alone: no lock
        self._full = 0
        self._failed = 0
        self._told = 0
        self._news = threading.Event()
        self._end = threading.Event()
        self._unsynced = False
        self._try(self._open)  # here, so that a wrong folder is said at the start
        self._thread = threading.Thread(target=self._run, name="journal", daemon=True)
        signals.start(self._thread)

    def put(self, line: Entry) -> None:
        """Leave a line to the thread; never waits."""
        if len(self._waiting) >= WAITING:
            self._full += 1
            return
        self._waiting.append(line)
        self._news.set()

    def close(self) -> None:
        """Write what waits, or leave the thread behind when its disk hangs."""
        self._end.set()
        self._news.set()
        self._thread.join(FLUSH)

    def _run(self) -> None:
        realtime.follow()
        ending = False
        while not ending:
            self._news.wait(SYNC if self._unsynced else None)
            ending = self._end.wait(GATHER)
            self._news.clear()
            self._write()
            if self._unsynced and (ending or clock.now() - self._synced >= SYNC):
                self._try(self._sync)
        self._shut()

    def _write(self) -> None:
        lines = [self._waiting.popleft() for _ in range(len(self._waiting))]
        if not lines:
            return
        lost = self._full + self._failed - self._told
        tail = [Entry(clock.stamp(), clock.now(), "lost", {"count": lost})] if lost else []
        if self._try(lambda: self._append(b"".join(line.encode() for line in lines + tail))):
            self._told += lost
        else:
            self._failed += len(lines)

    def _append(self, data: bytes) -> None:
        file = self._file or self._open()
        if self._size and self._size + len(data) > SIZE:
            file = self._turn()
        written = file.write(data)
        self._size += written
        self._unsynced = True
        if written < len(data):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    def _open(self) -> BinaryIO:
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._file = file = open(self._path, "ab", buffering=0, opener=_open_now)  # noqa: SIM115
        self._size = os.fstat(file.fileno()).st_size
        if self._size:  # a pulled battery or a full disk may have left half a line
            self._size += file.write(b"\n")
        return file

    def _turn(self) -> BinaryIO:
        self._shut()
        self._path.replace(self._path.with_suffix(".old"))
        return self._open()

    def _sync(self) -> None:
        self._unsynced, self._synced = False, clock.now()
        if self._file:
            os.fsync(self._file.fileno())

    def _shut(self) -> None:
        if self._file:
            self._file.close()
            self._file = None

    def _try(self, action: Callable[[], object]) -> bool:
        try:
            action()
        except OSError as error:
            self.trouble = f"{self._path}: {error.strerror}"
            self._shut()
            return False
        return True


def _open_now(path: str, flags: int) -> int:
    """Open a file; a pipe in its place, which nobody reads, would be waited for, for ever."""
    file = os.open(path, flags | os.O_NONBLOCK, 0o666)
    os.set_blocking(file, True)
    return file


def _harmless(value: Any) -> Any:
    return printable(value[:LONG]) if isinstance(value, str) else value
