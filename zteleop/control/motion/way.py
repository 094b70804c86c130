"""A way of straight lines, arcs and turns on the spot, held by where odometry says the robot is."""

from collections.abc import Sequence
from math import atan2, copysign, pi, remainder, sin, tau
from typing import NamedTuple

from zteleop.control.motion.course import COAST, LAG
from zteleop.control.motion.pose import Pose2D
from zteleop.messages import Twist

OFF, ASKEW = 6.0, 4.0
"""How hard a way is held: 1/m for each m off it, and for each rad askew."""
GAIN, BRAKE = 3.0, 3.0
"""rad/s for each rad that is left of a turn on the spot, and m/s for each m of a line before one"""
SLOWEST = 0.4
"""of the speed, as less may not overcome the friction"""


class Leg(NamedTuple):
    """A part of a way from a pose: so long, m, bent so much, 1/m; or a turn on the spot, rad."""

    start: Pose2D
    length: float
    bend: float = 0.0
    turn: float = 0.0

    @property
    def end(self) -> Pose2D:
        return self.at(self.length) if not self.turn else self.start.ahead(0.0, 0.0, self.turn)

    def at(self, along: float) -> Pose2D:
        """Return the pose that is right after so many m."""
        return self.start.roll(along, along * self.bend)

    def along(self, pose: Pose2D) -> float:
        """Return the m of it that lie behind a pose; less than 0 before its start."""
        ahead, left = self.start.local(pose.x, pose.y)
        if not self.bend:
            return ahead
        side = copysign(1.0, self.bend)
        swept = atan2(ahead, 1 / abs(self.bend) - side * left)
        return (swept if swept > -pi / 2 else swept + tau) / abs(self.bend)


class Way:
    """Holds legs one after another, each from where the one before should have ended."""

    def __init__(self, legs: Sequence[Leg], speed: float, turn_speed: float, most_bend: float) -> None:
        """Take m/s along lines and arcs, rad/s on the spot, and the most curvature that corrects, 1/m."""
        self._legs = legs
        self._number = 0
        self._speed = speed
        self._turn_speed = turn_speed
        self._most_bend = most_bend

    def twist(self, pose: Pose2D, now: float) -> Twist | None:
        """Return what holds the way from a pose; None at its end."""
        while self._number < len(self._legs):
            leg = self._legs[self._number]
            twist = self._turn(leg, pose) if leg.turn else self._follow(leg, pose)
            if twist:
                return twist
            self._number += 1
        return None

    def _turn(self, leg: Leg, pose: Pose2D) -> Twist | None:
        left = remainder(leg.end.heading - pose.heading, tau)
        rate = min(self._turn_speed, max(SLOWEST * self._turn_speed, GAIN * abs(left)))
        return Twist.planar(0.0, copysign(rate, left)) if abs(left) > rate * COAST else None

    def _follow(self, leg: Leg, pose: Pose2D) -> Twist | None:
        along = leg.along(pose)
        speed = self._braked(leg.length - along) if self._stops_after(leg) else self._speed
        if along + speed * LAG >= leg.length:
            return None
        right = leg.at(along)
        off, askew = right.local(pose.x, pose.y)[1], remainder(pose.heading - right.heading, tau)
        bend = leg.bend - OFF * off - ASKEW * sin(askew)
        return Twist.planar(speed, speed * max(-self._most_bend, min(self._most_bend, bend)))

    def _braked(self, left: float) -> float:
        return min(self._speed, max(SLOWEST * self._speed, BRAKE * left))

    def _stops_after(self, leg: Leg) -> bool:
        after = self._legs[self._number + 1 : self._number + 2]
        return bool(after and after[0].turn)


def square(start: Pose2D, side: float, radius: float, to_right: bool = False) -> list[Leg]:
    """Return four sides, m, joined by arcs of a radius, m; of radius 0 by turns on the spot."""
    turn = -pi / 2 if to_right else pi / 2
    legs: list[Leg] = []
    for _ in range(4):
        legs.append(Leg(start, side))
        corner = legs[-1].end
        legs.append(
            Leg(corner, radius * abs(turn), copysign(1 / radius, turn))
            if radius
            else Leg(corner, 0.0, 0.0, turn)
        )
        start = legs[-1].end
    return legs
