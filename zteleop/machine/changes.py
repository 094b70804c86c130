"""Tells of a file that is changed under a running program: in a thread, as a disk may hang."""

import threading
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from zteleop.machine import signals

LOOK_EVERY = 1.0
LARGEST = 2**20
"""bytes that are compared"""


class Changes:
    """What a file holds, and held at the start; one that cannot be read just now has not changed."""

    def __init__(self, path: Path) -> None:
        self._path = path.absolute()
        self._name = path
        self._mark = self._seen()
        self._first = self._last = self._content()

    def watch(self, tell: Callable[[str], object]) -> None:
        """Tell of each change from now on, from a thread of its own."""
        signals.start(threading.Thread(target=self._run, args=(tell,), name="changes", daemon=True))

    def _run(self, tell: Callable[[str], object]) -> None:
        while True:
            self.look(tell)
            time.sleep(LOOK_EVERY)

    def look(self, tell: Callable[[str], object]) -> None:
        """Tell of other content, once; that of the start is what the program goes by."""
        if (mark := self._seen()) is None or mark == self._mark:
            return
        content = self._content()
        if content is None:
            return
        self._mark = mark
        if content not in (self._last, self._first):
            tell(f"{self._name} has changed; what it says counts once this is started again")
        self._last = content

    def _seen(self) -> tuple[int, ...] | None:
        with suppress(OSError):
            found = self._path.stat()
            return found.st_mtime_ns, found.st_size, found.st_ino
        return None

    def _content(self) -> bytes | None:
        with suppress(OSError), self._path.open("rb") as file:
            return file.read(LARGEST)
        return None
