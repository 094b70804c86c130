"""A car whose servo and ESC are not what its settings say, as every real one is until it is calibrated."""

from collections.abc import Mapping
from random import Random
from typing import NamedTuple

from zteleop.control.servo import Reverse, Servo
from zteleop.sim.car import CarSettings

STRAIGHT_OFF, NEUTRAL_OFF = 60.0, 30.0
"""us, at most, by which neutral is somewhere else"""
REACH = (250.0, 400.0)
"""us from neutral to an end"""
DEADBAND = (10.0, 40.0)
"""us to either side of neutral in which the motor rests"""
STYLES: tuple[Reverse, ...] = ("direct", "double_tap")


class Unknown(NamedTuple):
    servos: dict[str, Servo]
    settings: CarSettings


def unknown(servos: Mapping[str, Servo], seed: int) -> Unknown:
    """Return what a car really is: another one for each seed, on the channels that are known."""
    chance = Random(seed)
    steering = _servo(chance, servos["steering"], STRAIGHT_OFF, mirrored=chance.random() < 0.5)
    throttle = _servo(chance, servos["throttle"], NEUTRAL_OFF, mirrored=False)
    deadband = round(chance.uniform(*DEADBAND), 1)
    settings = CarSettings(esc_deadband_us=deadband, reverse=chance.choice(STYLES))
    return Unknown({"steering": steering, "throttle": throttle}, settings)


def _servo(chance: Random, known: Servo, off: float, *, mirrored: bool) -> Servo:
    neutral = known.neutral_us + chance.uniform(-off, off)
    least, most = neutral - chance.uniform(*REACH), neutral + chance.uniform(*REACH)
    if mirrored:  # built in upside down
        least, most = most, least
    return Servo(known.channel, round(least, 1), round(neutral, 1), round(most, 1))
