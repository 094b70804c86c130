"""The six lights around the power button: what the robot shows of itself, unless somebody else shows more."""

from collections.abc import Container
from math import ceil

from zteleop.messages import LedColor, LightringLeds

LIGHTS = 6
WHITE, ORANGE, RED, DARK = (
    LedColor(255, 255, 255),
    LedColor(255, 102, 0),
    LedColor(255, 0, 0),
    LedColor(0, 0, 0),
)
REAR = (0, 4, 5)
"""at 4, 8 and 6 o'clock"""
LOW, EMPTY = 0.1, 0.03
"""of a full battery"""
PULSE, SPIN = 1.0, 0.6
"""s"""


class Lightring:
    """What is told by `cmd_lightring` stays until it is taken back."""

    def __init__(self) -> None:
        self.told: list[LedColor] | None = None

    def hear(self, message: LightringLeds) -> None:
        self.told = list(message.leds) if message.override_system else None

    def show(self, time: float, charge: float, charging: bool, backs_up: bool) -> list[LedColor]:
        """Return all six at a time in s, for a battery's charge, 0 to 1."""
        return self.told or own_lights(time, charge, charging, backs_up)


def own_lights(time: float, charge: float, charging: bool, backs_up: bool) -> list[LedColor]:
    """Return what it shows by itself."""
    if charge < EMPTY:
        return _some([int(time / SPIN * LIGHTS) % LIGHTS], RED)
    if charge < LOW:
        return [RED if time % PULSE < PULSE / 2 else DARK] * LIGHTS
    if charging:
        return _some(range(ceil(charge * LIGHTS)), WHITE)
    return _some(REAR, ORANGE) if backs_up else [WHITE] * LIGHTS


def _some(lit: Container[int], colour: LedColor) -> list[LedColor]:
    return [colour if light in lit else DARK for light in range(LIGHTS)]
