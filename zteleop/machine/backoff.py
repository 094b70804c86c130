"""How long to wait before a process that ended is started again."""

FIRST_PAUSE, LONGEST_PAUSE = 0.1, 5.0
"""s between an end and the next start; doubled each time, until one has lived for STEADY."""
STEADY = 10.0


class BackOff:
    """Pauses that grow: the first as given, in s, then from FIRST_PAUSE on twice the one before."""

    def __init__(self, first: float = FIRST_PAUSE) -> None:
        self._first = first
        self._next = first

    def pause(self, lived: float) -> float:
        """Return the pause after a process that lived for so many s."""
        if lived > STEADY:
            self._next = self._first
        pause = self._next
        self._next = min(max(FIRST_PAUSE, 2 * pause), LONGEST_PAUSE)
        return pause
