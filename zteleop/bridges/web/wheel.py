"""The one wheel of a server: pages take it in turn, and whoever holds it drives by what that page says.

It is an input as any other. A page says all that is held, again and again; one that falls silent holds
nothing. Who takes the wheel, or comes back after anything that ended a claim, must let go first.
"""

from typing import Self

from msgspec.structs import replace

from zteleop.bridges.web.words import Held
from zteleop.control.stick import Speeds, Stick
from zteleop.inputs import Drive, Wish
from zteleop.messages import Vehicle

SILENCE = 0.3
"""s without a word of the page that holds it, after which nothing is held"""
FULL = Speeds(forward=100.0, turn=100.0)
"""m/s and rad/s of full axes: all that the robot can, of which a page asks for a share"""
NOTHING = Held(0, 0.0, 0.0, False, 0, 0.0)


class Wheel:
    """Times are the bus clock's, in s."""

    drive: Drive = "hold"

    def __init__(self) -> None:
        self.speeds = FULL
        self.rested = False
        self.wish: Wish | None = None
        self.finished = False
        """The server ends."""
        self.holder = ""
        """which page"""
        self._held = NOTHING
        self._at = float("-inf")
        self._ready = False
        """nothing was held since whatever must be followed by that"""
        self._resting: dict[str, bool] = {}
        """of each page whether it holds nothing, as far as it has said"""

    @property
    def echo(self) -> Held:
        """What the page that drives said last, with the beat that it had heard."""
        return self._held

    def join(self, page: str) -> None:
        """Take in that there is a page, which holds nothing: what it finds held it does not count."""
        self._resting[page] = True

    def take(self, page: str, now: float) -> str:
        """Give the wheel to a page; where another drives, return why not."""
        if page == self.holder:
            return ""
        if self.is_held(now):
            return f"{self.holder} drives: it must let go, or hand over"
        self._pass_to(page, now)
        return ""

    def hand_over(self, page: str, now: float) -> str:
        """Let a page give the wheel up; where it has none, return so."""
        if page != self.holder:
            return f"{self.holder or 'nobody'} has the wheel"
        self._pass_to("", now)
        return ""

    def leave(self, page: str, now: float) -> None:
        """Take in that a page is gone: nobody holds what it held."""
        self._resting.pop(page, None)
        if page == self.holder:
            self._pass_to("", now)

    def hear(self, page: str, held: Held, now: float) -> bool:
        """Take in what a page holds; False when it is not the one that drives, or says nothing new.

        Nobody's wheel is whose page first holds something, and drives if that held nothing before.
        """
        if not self.holder and held.deadman:
            self._pass_to(page, now)
        self._resting[page] = not held.deadman
        if page != self.holder or held.seq <= self._held.seq:
            return False
        self._held, self._at = held, now
        if not held.deadman:
            self._ready = self.rested = True
        return True

    def is_held(self, now: float) -> bool:
        """Say whether the page that has the wheel holds something."""
        return self._held.deadman and now - self._at < SILENCE

    def fileno(self) -> int | None:
        """Return None: pages come by another thread, which says so."""
        return None

    def fit(self, vehicle: Vehicle) -> None:
        """Learn nothing: axes are of full range, whatever that is."""

    def read(self, now: float) -> bool:
        """Say whether somebody holds something that counts: that is an act as long as it lasts."""
        return self.is_held(now) and self._ready

    def stick(self, now: float) -> Stick:
        """Return where the stick is now."""
        if not self.is_held(now) or not self._ready:
            return Stick()
        return Stick(self._held.drive, self._held.turn, deadman=True)

    def reset(self, now: float) -> None:
        """Go back to neutral; what is held must be let go first."""
        self._ready = not self._held.deadman

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        self.holder = ""

    def _pass_to(self, page: str, now: float) -> None:
        # neutral is still said in the name of who had it, with the beat that he had heard
        self._held = replace(NOTHING, epoch=self._held.epoch, beat=self._held.beat)
        self.holder, self._at = page, now
        self._ready, self.rested = self._resting.get(page, False), True
