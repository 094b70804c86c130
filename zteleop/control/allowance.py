"""A token bucket: some at once, then one every so often."""


class Allowance:
    """Lets `at_once` pass, and one more each `every` seconds."""

    def __init__(self, at_once: int, every: float) -> None:
        self._at_once = at_once
        self._every = every
        self._left = float(at_once)
        self._counted = float("-inf")

    def has(self, now: float) -> bool:
        """Say whether one more may pass now."""
        self._left = min(self._at_once, self._left + max(0.0, now - self._counted) / self._every)
        self._counted = now
        return self._left >= 1.0

    def spend(self, now: float) -> None:
        self._left -= 1.0
