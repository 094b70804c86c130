"""A ring that knows how much it has lost: for whoever must be able to say so."""

import threading
from collections import deque

from zteleop.bus.session import Sample


class OverheardRing:
    """Keeps the newest samples, in whatever thread they come; of a flood the oldest are lost, and counted."""

    def __init__(self, depth: int) -> None:
        self._samples: deque[Sample] = deque(maxlen=depth)
        self._depth = depth
        self._arrived = threading.Semaphore(0)
        self._taking = threading.Lock()
        self._closed = False
        self.skipped = 0
        """How many were lost so far."""

    def take(self, sample: Sample) -> None:
        """Keep a sample."""
        with self._taking:
            is_full = len(self._samples) == self._depth
            self.skipped += is_full
            self._samples.append(sample)
        if not is_full:
            self._arrived.release()

    def try_recv(self) -> Sample | None:
        """Return the oldest that is kept."""
        if not self._arrived.acquire(blocking=False):
            return None
        return self._pop()

    def recv(self) -> Sample:
        """Wait for one; raises EOFError once it is closed."""
        self._arrived.acquire()
        return self._pop()

    def close(self) -> None:
        """End whoever waits."""
        self._closed = True
        self._arrived.release()

    def undeclare(self) -> None:
        self.close()

    def _pop(self) -> Sample:
        with self._taking:
            if not self._samples:
                self._arrived.release()  # for whoever waits as well
                raise EOFError("closed")
            return self._samples.popleft()
