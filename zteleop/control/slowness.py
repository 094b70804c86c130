"""Whether a chip's bus is too slow to drive on, by what its writes take."""

SLOW = 0.05
"""s for a write, beyond which nothing more is asked of the bus in that step"""
SLOW_WRITES, QUICK_WRITES = 3, 25
"""in a row make a bus that is too slow to drive on, or one that is so no more"""


class Slowness:
    """Counts writes in a row that were slow, or quick."""

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
    def lasts(self) -> bool:
        """It is too slow to drive on."""
        return self._slow >= SLOW_WRITES

    @property
    def is_over(self) -> bool:
        """There was none for so long that the bus is surely quick again."""
        return self._quick >= QUICK_WRITES
