"""Where a robot should be by what its wheels were told, or say themselves: an estimate that drifts."""

from math import exp, remainder, tau
from typing import Annotated, Literal

from msgspec import Meta, Struct

from zteleop.control import create3, curvature
from zteleop.control.motion.pose import Pose2D
from zteleop.messages import (
    Header,
    Odometry,
    PoseWithCovariance,
    Time,
    TransformStamped,
    Twist,
    TwistWithCovariance,
)

Positive = Annotated[float, Meta(gt=0, le=1e6)]
X, Y, HEADING = 0, 7, 35
"""Where these stand in a 6 x 6 covariance."""
FASTEST = 10.0
"""m/s of a wheel; ticks that would be more have begun to count anew"""


class OdometrySettings(Struct, frozen=True, forbid_unknown_fields=True):
    """How dead reckoning knows what the wheels did, for `zteleop odometry`."""

    wheels: Literal["ticks", "told"] = "ticks"
    """what their encoders say on `wheel_ticks`, where there are any; or only what they were told"""
    ticks_per_metre: Positive = round(create3.TICKS_PER_TURN / (tau * create3.WHEEL_RADIUS), 1)
    """of an encoder; a Create 3's"""
    track: Positive = create3.TRACK
    """m between wheels that have encoders"""
    imu: bool = True
    """take the heading from `imu`, where there is one"""
    motor_lag: Annotated[float, Meta(ge=0, le=10)] = 0.15
    """s to reach 63 % of a new speed"""
    scale: Annotated[float, Meta(gt=0, le=10)] = 1.0
    """m that it drives for each m it is told; measure it"""
    error: Annotated[float, Meta(gt=0, le=1)] = 0.1
    """by which it may be wrong, as a part of the way"""
    heading_error: Annotated[float, Meta(gt=0, le=10)] = 0.1
    """rad by which it may be wrong for each m; an imu does not drift so"""


class DeadReckoning:
    """Counts from 0, 0, 0: by a twist or by wheels, and with the heading of an IMU once there is one."""

    def __init__(self, settings: OdometrySettings, steers: bool = False) -> None:
        self._settings = settings
        self.steers = steers
        """The vehicle steers, as a car does: while it stands it does not turn."""
        self.pose = Pose2D()
        self.speed = 0.0
        self.yaw_rate = 0.0
        self.distance = 0.0
        """m rolled since the start, back and forth"""
        self._ticks: tuple[int, int] | None = None
        self._compass: float | None = None
        self._ahead: float | None = None
        """What the IMU said when its heading was first, and last, put into the pose."""

    def obey(self, told: Twist, dt: float) -> None:
        """Go on for dt s with wheels that are told a twist."""
        speed, turn = told.linear.x * self._settings.scale, told.angular.z
        lag = self._settings.motor_lag
        share = 1 - exp(-dt / lag) if lag else 1.0
        self.speed += (speed - self.speed) * share
        if self.steers:
            self.yaw_rate = self.speed * curvature.of(told.linear.x, turn)
        else:
            self.yaw_rate += (turn - self.yaw_rate) * share
        self._roll(self.speed * dt, self.yaw_rate * dt)

    def count(self, left: int, right: int, dt: float) -> None:
        """Go on to what two encoders say, dt s after they last did; one that begins anew moves nothing."""
        before, self._ticks = self._ticks, (left, right)
        if before is None or not dt > 0:
            return
        ways = [
            (now - then) / self._settings.ticks_per_metre
            for now, then in zip(self._ticks, before, strict=True)
        ]
        if max(map(abs, ways)) > FASTEST * max(dt, 0.1):
            return
        way, turned = sum(ways) / 2, (ways[1] - ways[0]) / self._settings.track
        self.speed, self.yaw_rate = way / dt, turned / dt
        self._roll(way, turned)

    def look(self, compass: float) -> None:
        """Take in what an IMU says of the heading, rad; it counts from where the heading is by then."""
        if self._ahead is None:
            self._ahead = self.pose.heading - compass
        self._compass = compass

    def forget_compass(self) -> None:
        """Go on by the wheels alone: the IMU has fallen silent."""
        self._ahead = self._compass = None

    def odometry(self, stamp: Time) -> Odometry:
        """Return pose and twist; their covariance is never 0, and grows with the way."""
        off, askew = self._errors()
        covariance = [0.0] * 36
        covariance[X] = covariance[Y] = off**2
        covariance[HEADING] = askew**2
        twist = [0.0] * 36
        twist[X], twist[HEADING] = (self._settings.error * self.speed) ** 2 + 1e-6, 1e-2
        return Odometry(
            Header(stamp, "odom"),
            "base_link",
            PoseWithCovariance(self.pose.message(), covariance),
            TwistWithCovariance(Twist.planar(self.speed, self.yaw_rate), twist),
        )

    def transform(self, stamp: Time) -> TransformStamped:
        """Return the pose as a transform from odom to base_link."""
        return self.pose.transform(stamp)

    def _errors(self) -> tuple[float, float]:
        """Return by how many m and rad the pose may be wrong."""
        askew = 0.02 + self._settings.heading_error * (0.0 if self._compass is not None else self.distance)
        return 0.01 + self._settings.error * self.distance, askew

    def _roll(self, way: float, turned: float) -> None:
        if self._compass is not None and self._ahead is not None:
            turned = remainder(self._compass + self._ahead - self.pose.heading, tau)
        self.pose = self.pose.roll(way, turned)
        self.distance += abs(way)
