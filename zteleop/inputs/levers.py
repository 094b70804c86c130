"""The Donkeycar way to drive: every press moves a lever one step, and there it stays."""

from typing import Annotated, Literal

from msgspec import Meta, Struct

from zteleop.control.stick import Stick
from zteleop.errors import ConfigError
from zteleop.messages import Channel, Vehicle

Axis = Literal["steering", "throttle"]
Step = Annotated[int, Meta(ge=1, le=4095)]


class Steps(Struct, frozen=True, forbid_unknown_fields=True):
    """How far one press moves, in counts of the chip's 4096 a period."""

    steering_step_ticks: Step = 15
    throttle_step_ticks: Step = 1

    def of(self, axis: Axis) -> int:
        """Return one axis's step."""
        return self.steering_step_ticks if axis == "steering" else self.throttle_step_ticks


class Lever:
    """One axis, in whole steps from neutral, or from the end of its dead zone; the last may be shorter."""

    def __init__(self, channel: Channel, step: int) -> None:
        self.channel = channel
        self._step = step
        self.steps = 0

    def press(self, sign: int) -> None:
        """Move one step towards max_ticks (1: left, forward) or min_ticks (-1); at the end stay."""
        steps = self.steps + sign
        if abs(steps) <= self.most(steps):
            self.steps = steps

    def most(self, sign: int) -> int:
        """Return how many steps there are from neutral to one end."""
        return -(-max(0, abs(self._span(sign)) - self.channel.dead_ticks) // self._step)

    def count(self, ticks: int) -> int:
        """Return how many steps from neutral these ticks are, rounded away from it; all only at its end."""
        moved = ticks - self.channel.neutral_ticks
        sign = 1 if moved * self._span(1) > 0 or moved * self._span(-1) < 0 else -1
        steps, most = -(-max(0, abs(moved) - self.channel.dead_ticks) // self._step), self.most(sign)
        if 1 < most <= steps and abs(moved) < abs(self._span(sign)):
            steps = most - 1
        return sign * steps

    @property
    def ticks(self) -> int:
        return self.ticks_at(self.steps)

    def ticks_at(self, steps: int) -> int:
        """Return the ticks of so many steps; 1 is left or forward."""
        span = self._span(steps)
        moved = min(abs(steps) * self._step + self.channel.dead_ticks, abs(span)) if steps else 0
        return self.channel.neutral_ticks + (moved if span > 0 else -moved)

    @property
    def fraction(self) -> float:
        """Where the lever is, -1 to 1 of its side."""
        moved = abs(self.ticks - self.channel.neutral_ticks)
        return moved / abs(self._span(self.steps)) * (1 if self.steps > 0 else -1) if moved else 0.0

    def _span(self, sign: int) -> int:
        end = self.channel.max_ticks if sign > 0 else self.channel.min_ticks
        return end - self.channel.neutral_ticks


class Levers:
    """Steering and throttle; without a calibration they do not move."""

    def __init__(self, steps: Steps | None = None) -> None:
        self._steps = steps or Steps()
        self._levers: dict[Axis, Lever] = {}

    def fit(self, vehicle: Vehicle) -> bool:
        """Take the calibration of a vehicle; another one is neutral again, and True.

        Raises ConfigError for a vehicle without steering and throttle.
        """
        channels = {channel.name: channel for channel in vehicle.channels}
        if not {"steering", "throttle"} <= channels.keys():
            raise ConfigError(
                "driving in steps needs the channels steering and throttle, "
                f"found {', '.join(sorted(channels)) or 'none'}; drive with --drive hold"
            )
        axes: tuple[Axis, ...] = ("steering", "throttle")
        if all(axis in self._levers and self._levers[axis].channel == channels[axis] for axis in axes):
            return False
        self._levers = {axis: Lever(channels[axis], self._steps.of(axis)) for axis in axes}
        return True

    def press(self, axis: Axis, sign: int) -> None:
        """Move one lever one step; 1 is left or forward."""
        if axis in self._levers:
            self._levers[axis].press(sign)

    def neutral(self, *axes: Axis) -> None:
        """Bring these levers to rest, or all."""
        for axis in axes or tuple(self._levers):
            if axis in self._levers:
                self._levers[axis].steps = 0

    def stick(self) -> Stick:
        """Return the levers as a stick, held while any is off neutral."""
        if not any(lever.steps for lever in self._levers.values()):
            return Stick()
        return Stick(self._levers["throttle"].fraction, self._levers["steering"].fraction, deadman=True)
