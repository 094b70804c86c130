"""What is known of the chip, and how: never what was only meant."""

from collections.abc import Mapping
from typing import NamedTuple

from zteleop.messages import Confirmed


class Evidence(NamedTuple):
    """What the chip took last, and whether a robot that is stopped is known to stand."""

    pulse_us: Mapping[int, float]
    """by channel"""
    written: float
    """when, by the robot's clock"""
    confirmed: Confirmed = ""
