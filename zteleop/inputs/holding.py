"""The drive while keys are held: told by the terminal where it tells releases, else guessed by repeats."""

from zteleop.control.stick import Stick
from zteleop.inputs.down_keys import DownKeys
from zteleop.inputs.held_keys import HeldKeys
from zteleop.inputs.keymap import Moves
from zteleop.terminal.keys import Key

UNCONFIRMED = 0.4
"""of full speed, for a press that may have been a touch: it counts for 0.6 s"""


class Holding:
    """The keys of one operator, as a stick; `now` in s."""

    def __init__(self) -> None:
        self.told = False
        """Releases are told, and a repeat says nothing that was not said."""
        self.steers = True
        """The robot turns by wheels that steer."""
        self._guess = HeldKeys()
        self._down = DownKeys()

    def be_told(self, told: bool) -> None:
        """Learn whether releases are told; a key that was held otherwise counts as let go."""
        if told != self.told:
            self.told = told
            self.clear()

    @property
    def known(self) -> bool:
        """Whether a key is down for certain."""
        return self._down.any

    def press(self, key: Key, moves: Moves, now: float) -> None:
        """Take in a key that drives."""
        moves = moves if self.steers else swing(moves)
        if not self.told:
            self._guess.press(key.name, moves, now)
        elif key.event == "press":
            self._down.press(key.place or key.name, moves, now)

    def release(self, key: Key) -> None:
        """Take in that a key was let go."""
        self._down.release(key.place or key.name)

    def clear(self) -> None:
        """Count every key as let go."""
        self._guess.clear()
        self._down.clear()

    def look_away(self, now: float) -> None:
        """Count every key as let go, and whatever is pressed soon as a key that was down meanwhile."""
        self.clear()
        self._down.look_away(now)

    def stick(self, now: float) -> Stick:
        """Return what the held keys ask for; nobody holds it when none is."""
        if self.told:
            return self._down.stick()
        stick = self._guess.stick(now)
        return stick if self._guess.confirmed else slowed(stick, self.steers)


def slowed(stick: Stick, steers: bool) -> Stick:
    """Return what may be asked for by a press that no repeat has confirmed; wheels may steer all the way."""
    turn = stick.turn if steers else UNCONFIRMED * stick.turn
    return stick._replace(forward=UNCONFIRMED * stick.forward, turn=turn)


def swing(moves: Moves) -> Moves:
    """Return how what turns on the spot backs to a side: its nose turns the other way."""
    if ("throttle", -1) not in moves:
        return moves
    return tuple((axis, -sign if axis == "steering" else sign) for axis, sign in moves)
