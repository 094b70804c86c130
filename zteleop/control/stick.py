"""From the position of a stick to a command.

For a car the turn axis is curvature: the wheels point where the stick points, at any speed.
"""

from math import tan
from typing import Annotated, NamedTuple

from msgspec import Meta, Struct

from zteleop.control import curvature
from zteleop.messages import Channel, Pwm, Twist, Vehicle

NotNegative = Annotated[float, Meta(ge=0, le=100)]


class Stick(NamedTuple):
    """What every input device yields: axes in -1..1, x forward, positive turn to the left."""

    forward: float = 0.0
    turn: float = 0.0
    deadman: bool = False
    """Somebody holds the stick; without it nobody drives."""


class Speeds(Struct, frozen=True, forbid_unknown_fields=True):
    """What a full stick means."""

    forward: NotNegative = 0.5
    """m/s"""
    turn: NotNegative = 1.0
    """rad/s; a car steers by curvature instead"""


def to_twist(stick: Stick, speeds: Speeds, vehicle: Vehicle) -> Twist | None:
    """Return the twist a stick asks for; None while nobody holds it."""
    if not stick.deadman:
        return None
    speed = stick.forward * min(speeds.forward, vehicle.max_speed)
    if vehicle.steers:
        return Twist.planar(speed, curvature.turn(speed, stick.turn * tightest(vehicle)))
    return Twist.planar(speed, stick.turn * min(speeds.turn, vehicle.max_turn))


def to_pwm(stick: Stick, vehicle: Vehicle) -> Pwm | None:
    """Return the ticks a stick asks for; None while nobody holds it."""
    if not stick.deadman:
        return None
    channels = {channel.name: channel for channel in vehicle.channels}
    return Pwm(ticks(channels["steering"], stick.turn), ticks(channels["throttle"], stick.forward))


def neutral_pwm(vehicle: Vehicle) -> Pwm:
    """Return the ticks at which a vehicle rests."""
    neutral = {channel.name: channel.neutral_ticks for channel in vehicle.channels}
    return Pwm(neutral["steering"], neutral["throttle"])


def ticks(channel: Channel, fraction: float) -> int:
    """Return the duty that stands for a fraction, -1..1, of a channel's range."""
    end = channel.max_ticks if fraction > 0 else channel.min_ticks
    return round(channel.neutral_ticks + abs(fraction) * (end - channel.neutral_ticks))


def tightest(vehicle: Vehicle) -> float:
    """Return the largest curvature, in 1/m, that the steering allows."""
    return tan(vehicle.max_steering_angle) / vehicle.wheelbase if vehicle.wheelbase else 0.0
