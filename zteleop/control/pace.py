"""Whether a chip's bus is quick enough to drive on, by what its writes take."""

SLOW = 0.05
"""s for a write, beyond which nothing more is asked of the bus in that step"""
SLOW_WRITES, QUICK_WRITES = 3, 25
"""in a row make a bus that is too slow to drive on, or one that is so no more"""


class Pace:
    """Writes in a row that were slow, or quick."""

    def __init__(self) -> None:
        self._slow = 0
        self._quick = 0

    def count(self, took: float) -> None:
        """Take in what a write took, in s."""
        if took > SLOW:
            self._slow += 1
            self._quick = 0
        else:
            self._quick += 1
            self._slow = 0

    @property
    def is_slow(self) -> bool:
        """The last write was."""
        return self._slow > 0

    @property
    def drags(self) -> bool:
        """It is too slow to drive on."""
        return self._slow >= SLOW_WRITES

    @property
    def runs(self) -> bool:
        """It is surely slow no more."""
        return self._quick >= QUICK_WRITES
