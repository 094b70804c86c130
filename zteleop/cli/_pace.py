"""Whether something that is to be done so many times a second is."""

from zteleop.control.proof import NEVER

TELL_AFTER = 2.0
"""s over which it is counted"""
ENOUGH = 0.9
"""of what was asked for; a timer's own jitter is less"""


class Pace:
    """Counts how often something is done, and says once that it is too seldom."""

    def __init__(self, rate: float) -> None:
        self._rate = rate
        self._began = NEVER
        self._done = 0
        self._last = NEVER
        self._told = False

    def count(self, now: float, awake_since: float = NEVER) -> str:
        """Take in that it is done now; return what is to be told, which is mostly nothing.

        Time in which its process stood still, up to `awake_since`, is not slowness.
        """
        if self._last <= awake_since:
            self._began, self._done = now, 0
        self._last = now
        done, lasted = self._done, now - self._began
        self._done += 1
        if self._told or lasted < TELL_AFTER or done >= ENOUGH * self._rate * lasted:
            return ""
        self._told = True
        return f"comes to {done / lasted:.0f} a second, of the {self._rate:g} asked for"
