"""What waits for one page: of each kind the newest only, so that a slow one skips, and holds up nobody."""

from collections.abc import Callable
from threading import Lock

Frame = str | bytes


class Slots:
    """Filled from any thread; `wake` is called once when there is something again, until all was taken."""

    def __init__(self, wake: Callable[[], object]) -> None:
        self._wake = wake
        self._waiting: dict[str, Frame] = {}
        """The kind that has waited the longest stands first."""
        self._lock = Lock()
        self._awake = False
        self.skipped = 0
        """frames that a newer one of their kind has replaced"""

    def put(self, kind: str, frame: Frame) -> None:
        """Let a frame wait in the place of an older one of its kind."""
        with self._lock:
            self.skipped += kind in self._waiting
            self._waiting[kind] = frame
            wakes, self._awake = not self._awake, True
        if wakes:
            self._wake()

    def take(self) -> Frame | None:
        """Return the frame whose turn it is; None when there is none, and whoever takes may sleep."""
        with self._lock:
            if not self._waiting:
                self._awake = False
                return None
            return self._waiting.pop(next(iter(self._waiting)))
