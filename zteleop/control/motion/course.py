"""What is done with a robot from now on, as long as it takes: a twist for some time, or for some laps."""

from math import remainder, tau
from typing import Protocol

from zteleop.control.motion.pose import Pose2D
from zteleop.messages import Twist

COAST = 0.08
"""s for which a robot turns on, about, when it is told to stop"""
LAG = 0.15
"""s from a command to what the wheels make of it, about"""


class Course(Protocol):
    def twist(self, pose: Pose2D, now: float) -> Twist | None:
        """Return what to do now, by the bus clock in s; None when it is done."""


class Steady:
    """One twist for some seconds, or without end."""

    def __init__(self, twist: Twist, seconds: float | None) -> None:
        self._twist = twist
        self._seconds = seconds
        self._began: float | None = None

    def twist(self, pose: Pose2D, now: float) -> Twist | None:
        self._began = now if self._began is None else self._began
        over = self._seconds is not None and now - self._began >= self._seconds
        return None if over else self._twist


class Laps:
    """One twist until the robot has turned so often."""

    def __init__(self, twist: Twist, laps: float) -> None:
        self._twist = twist
        self._turn = laps * tau
        self._turned = 0.0
        self._heading: float | None = None

    def twist(self, pose: Pose2D, now: float) -> Twist | None:
        if self._heading is not None:
            self._turned += remainder(pose.heading - self._heading, tau)
        self._heading = pose.heading
        ahead = COAST * abs(self._twist.angular.z)
        return None if abs(self._turned) + ahead >= self._turn else self._twist
