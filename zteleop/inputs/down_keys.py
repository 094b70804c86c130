"""Which keys are down on a terminal that tells every press and every release."""

from zteleop.control.stick import Stick
from zteleop.inputs.held_keys import pushed
from zteleop.inputs.keymap import Moves

RETURNED = 0.3
"""s after the focus came back in which a press may be of a key that was down all the time."""


class DownKeys:
    """What is held now: all keys that are down.

    Of two of one axis the one pressed last wins, and the other goes on after it.
    """

    def __init__(self) -> None:
        self._keys: dict[str, Moves] = {}
        """The last pressed is the last."""
        self._deaf_until = float("-inf")

    @property
    def any(self) -> bool:
        """Whether any is down."""
        return bool(self._keys)

    def press(self, key: str, moves: Moves, now: float) -> None:
        """Take in a press; never a repeat, which says nothing that was not said."""
        if now >= self._deaf_until:
            self._keys.pop(key, None)
            self._keys[key] = moves

    def release(self, key: str) -> None:
        """Take in that a key was let go."""
        self._keys.pop(key, None)

    def clear(self) -> None:
        """Count every key as let go; it must be pressed anew."""
        self._keys.clear()

    def look_away(self, now: float) -> None:
        """Count every key as let go, and each pressed soon as one that was down meanwhile."""
        self.clear()
        self._deaf_until = now + RETURNED

    def stick(self) -> Stick:
        """Return what the held keys ask for; nobody holds it when none is."""
        if not self._keys:
            return Stick()
        return pushed({axis: sign for moves in self._keys.values() for axis, sign in moves})
