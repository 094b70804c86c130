"""Two buttons on a robot as a stick: left forward, right turns left, both an arc, neither stands still."""

from collections.abc import Sequence
from typing import Self

from zteleop.control.stick import Speeds, Stick
from zteleop.inputs import Drive, Wish
from zteleop.messages import InterfaceButtons, Vehicle

LOST_AFTER = 1.5
"""s without a word of the buttons, which a robot says once a second and on each change"""
WORDS = {
    (False, False): "neither button is down",
    (True, False): "left: forward",
    (False, True): "right: turns left",
    (True, True): "both: an arc to the left",
}


class Buttons:
    """Held while the robot says so; one that was down at the start, or at a reset, counts once let go."""

    drive: Drive = "hold"

    def __init__(self, speeds: Speeds | None = None) -> None:
        self.speeds = speeds or Speeds()
        self.finished = False
        self.rested = False
        self.wish: Wish | None = None
        self._down = (False, False)
        self._heard = float("-inf")
        self._armed = False
        self._lost = False

    @property
    def about(self) -> Sequence[str]:
        """What is so of the buttons now, in words."""
        if not self.heard:
            return ["no button is heard yet"]
        if self._lost:
            return ["the buttons are no longer heard"]
        if not self._armed and any(self._down):
            return ["let go of the buttons first"]
        return [WORDS[self._down]]

    @property
    def heard(self) -> bool:
        """Somebody has told of them."""
        return self._heard > float("-inf")

    def hear(self, said: InterfaceButtons, now: float) -> None:
        """Take in what the robot says of its buttons."""
        down = said.button_1.is_pressed, said.button_2.is_pressed
        self.rested |= any(self._down) and not any(down)
        self._armed |= not any(down)
        self._down = down
        self._heard = now
        self._lost = False

    def fileno(self) -> None:
        """Return None: what is done comes by the bus."""

    def fit(self, vehicle: Vehicle) -> None:
        """Take any robot as it is: it bounds the speeds itself."""

    def read(self, now: float) -> bool:
        """Act for as long as a button is down; of one that nobody tells of any more, nothing is known."""
        if now - self._heard > LOST_AFTER:
            self._down = (False, False)
            self._armed = False
            self._lost = True
        return self._armed and any(self._down)

    def stick(self, now: float) -> Stick:
        """Return where the buttons push."""
        left, right = self._down if self._armed else (False, False)
        return Stick(float(left), float(right), deadman=left or right)

    def reset(self, now: float) -> None:
        """Be neutral; what is down must be let go first."""
        self._armed = False

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        self.finished = True
