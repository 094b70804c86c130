"""From the body's twist to its wheels and back, for each kind of vehicle.

Wheels are named fractions of full range, -1..1. One class per kind, one line at the end. Each says what
its kind can do (`steers`, `takes_ticks`, `driven`, `wheels`) and what a screen must know (`wheelbase` and
`max_steering_angle`, 0 where there are none; `max_speed`, `max_turn`). Of a twist only `linear.x` and
`angular.z` arrive: the limiter before passes no others.
"""

from math import atan, tan
from typing import Annotated

from msgspec import Meta, Struct

from zteleop.control import curvature
from zteleop.messages import Twist

Positive = Annotated[float, Meta(gt=0, le=1000)]
Length = Annotated[float, Meta(gt=0, le=10)]
"""m; more of them are centimetres"""
Wheels = dict[str, float]


class Ackermann(Struct, frozen=True, tag_field="kind", tag="ackermann", forbid_unknown_fields=True):
    """A car: one throttle, front wheels that steer (bicycle model)."""

    wheelbase: Length = 0.25
    """m between the axles"""
    max_steering_angle: Annotated[float, Meta(gt=0, lt=1.5)] = 0.4
    """rad to either side"""
    max_speed: Positive = 3.0
    """m/s at full throttle"""

    kind = "ackermann"
    steers = takes_ticks = True
    driven = frozenset({"throttle"})
    wheels = frozenset({"throttle", "steering"})

    @property
    def max_turn(self) -> float:
        """Yaw rate in rad/s at full speed and full lock."""
        return self.max_speed * tan(self.max_steering_angle) / self.wheelbase

    def mix(self, twist: Twist) -> Wheels:
        """Return throttle and steering for a twist."""
        speed = twist.linear.x
        angle = atan(self.wheelbase * curvature.of(speed, twist.angular.z))
        return {"throttle": _unit(speed / self.max_speed), "steering": _unit(angle / self.max_steering_angle)}

    def unmix(self, wheels: Wheels) -> Twist:
        """Return the twist that a throttle and a steering make."""
        speed = wheels["throttle"] * self.max_speed
        bend = tan(wheels["steering"] * self.max_steering_angle) / self.wheelbase
        return Twist.planar(speed, curvature.turn(speed, bend))


class Differential(Struct, frozen=True, tag_field="kind", tag="differential", forbid_unknown_fields=True):
    """Two driven wheels, `track` apart."""

    track: Length = 0.2
    """m between the wheels"""
    max_speed: Positive = 1.0
    """m/s of a wheel at full throttle"""

    kind = "differential"
    steers = takes_ticks = False
    driven = frozenset({"left", "right"})
    wheels = frozenset({"left", "right"})
    wheelbase = 0.0
    max_steering_angle = 0.0

    @property
    def max_turn(self) -> float:
        """Yaw rate in rad/s with the wheels at full speed, one forward, one back."""
        return 2 * self.max_speed / self.track

    def mix(self, twist: Twist) -> Wheels:
        """Return both wheels; what is too fast is scaled and keeps its radius."""
        turn = twist.angular.z * self.track / 2
        left, right = twist.linear.x - turn, twist.linear.x + turn
        scale = max(self.max_speed, abs(left), abs(right))
        return {"left": left / scale, "right": right / scale}

    def unmix(self, wheels: Wheels) -> Twist:
        """Return the twist that two wheels make."""
        left, right = wheels["left"] * self.max_speed, wheels["right"] * self.max_speed
        return Twist.planar((left + right) / 2, (right - left) / self.track)


Mixer = Ackermann | Differential


def _unit(value: float) -> float:
    return max(-1.0, min(1.0, value))
