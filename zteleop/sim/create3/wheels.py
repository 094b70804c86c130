"""The two wheels of a Create 3: how fast they may turn, how soon they do, and what their encoders count."""

from math import isfinite, tau

from zteleop.control.create3 import MAX_TURN, TICKS_PER_TURN, TRACK, WHEEL_RADIUS
from zteleop.messages import Twist

Pair = tuple[float, float]
STILL: Pair = (0.0, 0.0)


def wanted(twist: Twist, limit: float) -> Pair:
    """Return left and right in m/s for a twist; one factor scales both where it asks for too much.

    So the radius of the arc is kept. What is no number asks for nothing.
    """
    speed, turn = twist.linear.x, twist.angular.z
    if not (isfinite(speed) and isfinite(turn)):
        return STILL
    size = max(1.0, abs(speed), abs(turn))  # no sum of what is smaller overflows
    speed, turn = speed / size, turn / size
    left, right = speed - turn * TRACK / 2, speed + turn * TRACK / 2
    fastest = max(abs(left), abs(right))
    factor = min(size, _ratio(limit, fastest), _ratio(MAX_TURN, abs(turn)))
    return left * factor, right * factor


def _ratio(limit: float, value: float) -> float:
    return limit / value if value > 0 else float("inf")


class Wheels:
    """Speeds in m/s of the rims, and how far they have rolled, in m."""

    def __init__(self) -> None:
        self.speeds = STILL
        self.rolled = STILL

    @property
    def speed(self) -> float:
        return (self.speeds[0] + self.speeds[1]) / 2

    @property
    def yaw_rate(self) -> float:
        return (self.speeds[1] - self.speeds[0]) / TRACK

    @property
    def ticks(self) -> tuple[int, int]:
        """What the encoders have counted, left and right."""
        left, right = (int(way / (tau * WHEEL_RADIUS) * TICKS_PER_TURN) for way in self.rolled)
        return left, right

    @property
    def turning(self) -> Pair:
        """rad/s, left and right"""
        return self.speeds[0] / WHEEL_RADIUS, self.speeds[1] / WHEEL_RADIUS

    def halt(self) -> None:
        """Stand at once, as against a wall."""
        self.speeds = STILL

    def turn(self, target: Pair, acceleration: float, dt: float) -> None:
        """Go towards other speeds for `dt` s, both wheels by one factor."""
        changes = [to - now for to, now in zip(target, self.speeds, strict=True)]
        most = max(map(abs, changes))
        if most <= acceleration * dt:
            self.speeds = target
        else:
            share = acceleration * dt / most
            left, right = (now + share * by for now, by in zip(self.speeds, changes, strict=True))
            self.speeds = left, right

    def roll(self, dt: float) -> None:
        """Roll for `dt` s, as nothing was in the way."""
        left, right = (way + speed * dt for way, speed in zip(self.rolled, self.speeds, strict=True))
        self.rolled = left, right
