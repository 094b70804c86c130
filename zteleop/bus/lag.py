"""Notices a program that is slower than what it hears: the oldest are lost then, and nobody would know."""

from collections.abc import Callable

from zteleop.bus import clock

LAGS_AFTER = 1.0
"""s in which a message waited each time another was done with"""


class Lag:
    """Counts how fast messages are taken while others wait."""

    def __init__(self, tell: Callable[[str], object] = lambda words: None) -> None:
        self._tell = tell
        self._since: float | None = None
        self._taken = 0

    def is_over(self) -> None:
        """Note that nothing waits any more."""
        self._since = None

    def goes_on(self) -> None:
        """Note that a message waited when the one before was done with; after a while, tell."""
        now = clock.now()
        if self._since is None:
            self._since, self._taken = now, 0
            return
        self._taken += 1
        if (lasts := now - self._since) >= LAGS_AFTER:
            self._tell(
                f"messages come faster than this program takes them ({self._taken / lasts:.2g} a second): "
                "they wait, and the oldest are lost once too many do"
            )
            self._since = None
