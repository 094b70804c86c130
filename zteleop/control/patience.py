"""How long an actuator may be silent, while the watchdog is there to hear it."""

from zteleop.control.deadlines import ACTUATOR_SILENCE, ACTUATOR_START, LATE_STEP, LONGEST_START

FORGIVE_EVERY = 2.0
"""s; a watchdog that is late all the time would otherwise hear no silence at all"""
PER_LOOK, AT_MOST = 2, 1.0
"""times what a look took, and s, that the actuator may be silent in addition: it waits for the same bus"""


class Patience:
    """Times in s; an actuator that has not stepped yet has longer, by as much as those before needed."""

    def __init__(self, now: float) -> None:
        self._ticked = now
        self._woke = float("-inf")
        self._start = ACTUATOR_START

    def tick(self, now: float) -> None:
        """Say that the watchdog runs; what it did not hear while it was late is nobody's silence."""
        if now - self._ticked > LATE_STEP and now - self._woke > FORGIVE_EVERY:
            self._woke = now
        self._ticked = now

    def is_over(self, silence: float, look_took: float, ready: bool, now: float) -> bool:
        """Say whether that silence is too long; one that waits for a slow bus is not dead."""
        limit = ACTUATOR_SILENCE + min(PER_LOOK * look_took, AT_MOST) if ready else self._start
        return min(silence, now - self._woke) > limit

    def lose(self, silence: float, ready: bool) -> str:
        """Return what an actuator is killed for; one that never stepped leaves the next more time."""
        if ready:
            return f"it was silent for {silence:.2f} s"
        had = self._start
        self._start = min(2 * had, LONGEST_START)
        return f"it did not step within {had:g} s of its start, and the next has {self._start:g} s"

    def restore(self) -> None:
        """Take note that one has stepped: the next has as long as the first had."""
        self._start = ACTUATOR_START
