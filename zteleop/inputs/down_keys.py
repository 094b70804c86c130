"""Which keys are down on a terminal that tells every press and every release."""

from zteleop.control.stick import Stick

RETURNED = 0.3
"""s after the focus came back in which a press may be of a key that was down all the time."""


class DownKeys:
    """What is held now; axes are `forward` and `turn`, signs 1 and -1 (REP-103).

    All keys that are down count. Of two of one axis the one pressed last wins, and the other goes on
    after it.
    """

    def __init__(self) -> None:
        self._axes: dict[str, tuple[str, int]] = {}
        self._deaf_until = float("-inf")

    @property
    def any(self) -> bool:
        """Whether any is down."""
        return bool(self._axes)

    def press(self, key: str, axis: str, sign: int, now: float) -> None:
        """Take in a press; never a repeat, which says nothing that was not said."""
        if now >= self._deaf_until:
            self._axes.pop(key, None)
            self._axes[key] = axis, sign

    def release(self, key: str) -> None:
        """Take in that a key was let go."""
        self._axes.pop(key, None)

    def clear(self) -> None:
        """Count every key as let go; it must be pressed anew."""
        self._axes.clear()

    def look_away(self, now: float) -> None:
        """Count every key as let go, and each pressed soon as one that was down meanwhile."""
        self.clear()
        self._deaf_until = now + RETURNED

    def stick(self) -> Stick:
        """Return what the held keys ask for; nobody holds it when none is."""
        if not self._axes:
            return Stick()
        axes = dict(self._axes.values())  # of two of one axis the later one stays
        return Stick(float(axes.get("forward", 0)), float(axes.get("turn", 0)), deadman=True)
