"""What every vehicle is: a body on a plane that its wheels move, seen by itself as odometry (REP-103)."""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from math import ceil, cos, remainder, sin, tau
from typing import NamedTuple, Protocol

from zteleop.control.motion.pose import Pose2D
from zteleop.messages import (
    Header,
    Odometry,
    PoseWithCovariance,
    Time,
    Twist,
    TwistWithCovariance,
)
from zteleop.sim.odometer import Odometer

Pulses = Mapping[int, float | None]
"""Microseconds by channel; None, or no entry, where no pulse leaves the chip."""

SUBSTEP = 0.01
LONGEST_STEP = 1.0
"""s; whoever calls later than that has lost the rest."""


class Disc(NamedTuple):
    """A part of a body, round as seen from above: so far ahead of base_link, so large, m."""

    ahead: float
    radius: float


class Room(Protocol):
    def admits(self, before: Pose2D, after: Pose2D) -> bool:
        """Say whether the body may go from one pose to the next."""


class Body(ABC):
    """Pose of base_link in the odom frame (m, rad) and its velocity (m/s, rad/s)."""

    discs: tuple[Disc, ...]
    """what it is seen from above, and runs into things with"""

    def __init__(self) -> None:
        self.room: Room | None = None
        """what bounds where it goes; nothing on a floor without end"""
        self.x = 0.0
        self.y = 0.0
        self.heading = 0.0
        self.speed = 0.0
        self.yaw_rate = 0.0
        self.power = 1.0
        """Share of full speed that its battery is good for."""
        self.distance = 0.0
        """m rolled since the start, back and forth."""
        self.odometer = Odometer()
        """where it believes it is, by its wheels"""

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

    def went(self, way: float, turn: float, dt: float) -> None:
        """Note that it went some m and turned some rad in some s: nothing was in its way."""
        self.distance += abs(way)
        self.odometer.add(way, turn)

    def halt(self) -> None:
        """Stand, as what runs into something does; it may drive on at once."""
        self.speed = self.yaw_rate = 0.0

    @property
    def pose(self) -> Pose2D:
        return Pose2D(self.x, self.y, self.heading)

    def odometry(self, stamp: Time) -> Odometry:
        """Return pose and twist as its wheels tell them, in odom and base_link."""
        twist = Twist.planar(self.speed, self.yaw_rate)
        return Odometry(
            Header(stamp, "odom"),
            "base_link",
            PoseWithCovariance(self.odometer.pose.message(), self.odometer.covariance),
            TwistWithCovariance(twist, [0.0] * 36),
        )

    def _roll(self, dt: float) -> None:
        turn, way = self.yaw_rate * dt, self.speed * dt
        middle = self.heading + turn / 2
        x, y = self.x + way * cos(middle), self.y + way * sin(middle)
        heading = remainder(self.heading + turn, tau)
        if self.room and not self.room.admits(self.pose, Pose2D(x, y, heading)):
            self.halt()
            return
        self.x, self.y, self.heading = x, y, heading
        self.went(way, turn, dt)
