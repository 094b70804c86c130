"""What every vehicle is: a body on a plane that its wheels move, seen by itself as odometry (REP-103)."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from math import ceil, cos, remainder, sin, tau

from zteleop.messages import (
    Header,
    Odometry,
    Point,
    Pose,
    PoseWithCovariance,
    Quaternion,
    Time,
    Twist,
    TwistWithCovariance,
)

Pulses = Mapping[int, float | None]
"""Microseconds by channel; None, or no entry, where no pulse leaves the chip."""

SUBSTEP = 0.01
LONGEST_STEP = 1.0
"""s; whoever calls later than that has lost the rest."""


class Body(ABC):
    """Pose of base_link in the odom frame (m, rad) and its velocity (m/s, rad/s)."""

    def __init__(self) -> None:
        self.x = 0.0
        self.y = 0.0
        self.heading = 0.0
        self.speed = 0.0
        self.yaw_rate = 0.0
        self.distance = 0.0
        """m rolled since the start, back and forth."""

    @abstractmethod
    def move(self, pulse_us: Pulses, dt: float) -> None:
        """Set speed and yaw_rate to what they are after `dt` of these pulses."""

    def step(self, pulse_us: Pulses, dt: float) -> None:
        """Drive for `dt` seconds on these pulses; not at all unless dt > 0, and for a second at most."""
        if not dt > 0:
            return
        dt = min(dt, LONGEST_STEP)
        substeps = ceil(dt / SUBSTEP)
        for _ in range(substeps):
            self.move(pulse_us, dt / substeps)
            self._roll(dt / substeps)

    def odometry(self, stamp: Time) -> Odometry:
        """Return pose and twist, in odom and base_link."""
        turned = Quaternion(0.0, 0.0, sin(self.heading / 2), cos(self.heading / 2))
        pose = Pose(Point(self.x, self.y, 0.0), turned)
        twist = Twist.planar(self.speed, self.yaw_rate)
        return Odometry(
            Header(stamp, "odom"),
            "base_link",
            PoseWithCovariance(pose, [0.0] * 36),
            TwistWithCovariance(twist, [0.0] * 36),
        )

    def _roll(self, dt: float) -> None:
        turn, way = self.yaw_rate * dt, self.speed * dt
        self.x += way * cos(self.heading + turn / 2)
        self.y += way * sin(self.heading + turn / 2)
        self.heading = remainder(self.heading + turn, tau)
        self.distance += abs(way)
