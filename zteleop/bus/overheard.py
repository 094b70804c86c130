"""A ring that knows how much it has lost: for whoever must be able to say so."""

from contextlib import suppress
from queue import Empty, SimpleQueue

from zteleop.bus.session import Sample, Undeclarable


class OverheardRing:
    """Keeps the newest samples, in whatever thread they come; of a flood the oldest are lost, and counted."""

    def __init__(self, depth: int) -> None:
        self._samples: SimpleQueue[Sample | None] = SimpleQueue()
        """None is the end"""
        self._depth = depth
        self.declared: Undeclarable | None = None
        """What fills it, where that can be taken back."""
        self.skipped = 0
        """How many were lost so far."""

    def take(self, sample: Sample) -> None:
        """Keep a sample."""
        if self._samples.qsize() >= self._depth:
            with suppress(Empty):  # whoever reads was quicker
                self._samples.get_nowait()
                self.skipped += 1
        self._samples.put(sample)

    def try_recv(self) -> Sample | None:
        """Return the oldest that is kept."""
        try:
            return self._taken(self._samples.get_nowait())
        except (Empty, EOFError):
            return None

    def recv(self) -> Sample:
        """Wait for one; raises EOFError once it is closed, and all is read."""
        return self._taken(self._samples.get())

    def close(self) -> None:
        """End whoever waits; nothing may be taken any more."""
        self._samples.put(None)

    def undeclare(self) -> None:
        if self.declared:
            self.declared.undeclare()
        self.close()

    def _taken(self, sample: Sample | None) -> Sample:
        if sample is None:
            self.close()  # for whoever else waits
            raise EOFError("closed")
        return sample
