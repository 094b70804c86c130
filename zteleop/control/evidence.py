"""What is known of the chip, and how: never what was only meant."""

from collections.abc import Mapping
from typing import NamedTuple

from zteleop.messages import Confirmed

STANDS: dict[Confirmed, str] = {
    "read": "neutral read back from the chip",
    "cut": "its outputs are cut",
    "": "not confirmed by the chip: cut its power",
}
"""How a robot with a stop in force is known to stand, in words."""


class Evidence(NamedTuple):
    """What the chip took last, and whether a robot that is stopped is known to stand."""

    pulse_us: Mapping[int, float]
    """by channel"""
    written: float
    """when, by the robot's clock"""
    confirmed: Confirmed = ""
