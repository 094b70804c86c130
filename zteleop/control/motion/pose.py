"""Where a ground robot is, on the plane it drives on."""

from math import atan2, cos, hypot, remainder, sin, tau
from typing import NamedTuple

from zteleop.messages import (
    Header,
    Odometry,
    Point,
    Pose,
    Quaternion,
    Time,
    Transform,
    TransformStamped,
    Vector3,
)


class Pose2D(NamedTuple):
    """Place and heading in the odom frame, m and rad; 0 looks along x, a quarter turn to the left along y."""

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0

    def local(self, x: float, y: float) -> tuple[float, float]:
        """Return how far a place of the odom frame is ahead and to the left, m."""
        dx, dy, c, s = x - self.x, y - self.y, cos(self.heading), sin(self.heading)
        return c * dx + s * dy, c * dy - s * dx

    def ahead(self, forward: float, left: float = 0.0, turned: float = 0.0) -> "Pose2D":
        """Return the pose that is so far ahead, m, to the left, m, and turned, rad."""
        c, s = cos(self.heading), sin(self.heading)
        x, y = self.x + c * forward - s * left, self.y + s * forward + c * left
        return Pose2D(x, y, remainder(self.heading + turned, tau))

    def roll(self, way: float, turned: float) -> "Pose2D":
        """Return the pose after an arc so long, m, and so far round, rad."""
        half = turned / 2
        chord = way * (sin(half) / half if abs(half) > 1e-9 else 1.0)
        return self.ahead(chord * cos(half), chord * sin(half), turned)

    def distance(self, x: float, y: float) -> float:
        """Return the m to a place."""
        return hypot(x - self.x, y - self.y)

    def message(self) -> Pose:
        """Return it as ROS says it."""
        return Pose(Point(self.x, self.y, 0.0), turned_by(self.heading))

    def transform(self, stamp: Time) -> TransformStamped:
        """Return it as tf has it: base_link in odom."""
        place = Transform(Vector3(self.x, self.y, 0.0), turned_by(self.heading))
        return TransformStamped(Header(stamp, "odom"), "base_link", place)


def turned_by(heading: float) -> Quaternion:
    """Return how whatever stands upright is turned, by its heading in rad."""
    return Quaternion(0.0, 0.0, sin(heading / 2), cos(heading / 2))


def heading_of(turned: Quaternion) -> float:
    """Return the heading, rad, of whatever stands upright."""
    return atan2(
        2 * (turned.w * turned.z + turned.x * turned.y),
        1 - 2 * (turned.y * turned.y + turned.z * turned.z),
    )


def pose_of(odometry: Odometry) -> Pose2D:
    """Return where an odometry says its robot is."""
    pose = odometry.pose.pose
    return Pose2D(pose.position.x, pose.position.y, heading_of(pose.orientation))
