"""The three buttons on a Create 3: which is down, since when, and for how long it is or was."""

from typing import Literal, get_args

from zteleop.messages import Button, Duration, Header, InterfaceButtons, Time

Name = Literal["button_1", "button_power", "button_2"]
NAMES: tuple[Name, ...] = get_args(Name)
NANO = 1_000_000_000
FRAME = "base_link"


class Buttons:
    """All up at the start, and never pressed."""

    def __init__(self) -> None:
        self._down: dict[Name, bool] = dict.fromkeys(NAMES, False)
        self._since = dict.fromkeys(NAMES, 0)
        self._held = dict.fromkeys(NAMES, 0)

    @property
    def down(self) -> list[Name]:
        """Which are held."""
        return [name for name in NAMES if self._down[name]]

    def press(self, name: Name, down: bool, at: Time) -> bool:
        """Press a button or let it go; False when it is so already."""
        if self._down[name] == down:
            return False
        if down:
            self._since[name] = _count(at)
        self._held[name] = max(0, _count(at) - self._since[name])
        self._down[name] = down
        return True

    def message(self, now: Time) -> InterfaceButtons:
        """Return all three; the duration of one that is held grows."""
        return InterfaceButtons(Header(now, FRAME), *(self._button(name, now) for name in NAMES))

    def _button(self, name: Name, now: Time) -> Button:
        held = max(0, _count(now) - self._since[name]) if self._down[name] else self._held[name]
        since = Time(*divmod(self._since[name], NANO))
        return Button(Header(now, FRAME), self._down[name], since, Duration(*divmod(held, NANO)))


def _count(time: Time) -> int:
    """ns"""
    return time.sec * NANO + time.nanosec
