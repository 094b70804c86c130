"""A figure of eight, driven without a person: for demonstrations and trials."""

from math import pi
from typing import Self

from zteleop.control.stick import Speeds, Stick, tightest
from zteleop.inputs import Drive, Wish
from zteleop.messages import Vehicle


class Script:
    """An input that drives one figure, begun at the first read."""

    drive: Drive = "hold"

    def __init__(self, duration: float = 10.0, speeds: Speeds | None = None) -> None:
        self.duration = duration
        self.speeds = speeds or Speeds()
        self.finished = False
        self.rested = False
        self.wish: Wish | None = None
        self._began: float | None = None
        self._turn = 0.5

    def fileno(self) -> None:
        """Return None: there is nothing to wait for."""

    def fit(self, vehicle: Vehicle) -> None:
        """Choose the turn that closes each half to a circle, or the tightest there is."""
        speed = min(self.speeds.forward, vehicle.max_speed)
        car = vehicle.steers
        full = speed * tightest(vehicle) if car else min(self.speeds.turn, vehicle.max_turn)
        self._turn = min(1.0, 4 * pi / (self.duration * full)) if full else 0.0

    def read(self, now: float) -> bool:
        """Act, until the figure is done."""
        self._began = now if self._began is None else self._began
        self.finished = self.finished or now - self._began >= self.duration
        return not self.finished

    def stick(self, now: float) -> Stick:
        """Drive a circle to the left, then one to the right."""
        if self._began is None or self.finished:
            return Stick()
        left = now - self._began < self.duration / 2
        return Stick(1.0, self._turn if left else -self._turn, deadman=True)

    def reset(self, now: float) -> None:
        """Be neutral until the next read, which begins the figure anew."""
        self._began = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        self.finished = True
