"""Pure pursuit: drive the arc that leads to a place, and choose it anew all the time."""

from math import atan2, cos, hypot, pi, sqrt

from msgspec import Struct

from zteleop.control.motion.pace import easy_radius, least_radius, turn_speed
from zteleop.control.motion.pose import Pose2D
from zteleop.messages import Twist, Vehicle

BESIDE = pi / 3
"""rad to either side, beyond which a robot that can turns on the spot first"""
NEAR = 1.0
"""m/s for each m that is left"""
SLOWEST, CREEP = 0.5, 0.25
"""of its speed, and m/s: what it never slows down below, as less may not overcome the friction"""
ASIDE = 2.0
"""m/s^2 that a car may be pushed aside in a bend"""
AIM = 2.0
"""rad/s for each rad off"""


class Pursuit(Struct):
    """Leads a vehicle to a place of the odom frame, m, at most so fast, m/s, and so near, m."""

    vehicle: Vehicle
    x: float
    y: float
    speed: float
    within: float
    makes_room: bool = False
    """a car goes straight on until the place is out of the circles that it cannot drive"""

    def twist(self, pose: Pose2D, now: float = 0.0) -> Twist | None:
        """Return what to do now; None when the place is reached."""
        left = pose.distance(self.x, self.y)
        if left <= self.within:
            return None
        ahead, beside = pose.local(self.x, self.y)
        speed = min(self.speed, max(NEAR * left, min(SLOWEST * self.speed, CREEP)))
        if self.vehicle.steers:
            return self._steer(speed, ahead, beside)
        return self._turn(speed, atan2(beside, ahead))

    def _steer(self, speed: float, ahead: float, beside: float) -> Twist:
        least, easy = least_radius(self.vehicle), easy_radius(self.vehicle)
        gap = hypot(ahead, abs(beside) - easy) - easy
        """m from the place to the circle that a car plans to drive on its side; less than 0 inside"""
        self.makes_room = gap < (0.05 * least if self.makes_room else -self.within / 2)
        if self.makes_room:
            return Twist.planar(speed)
        bend = 2 * beside / (ahead * ahead + beside * beside)
        if ahead < 0 and abs(bend) * easy < 1:  # behind: turn round, not a wide arc
            bend = 1 / easy if beside >= 0 else -1 / easy
        most = 1 / least
        bend = max(-most, min(most, bend))
        speed = min(speed, sqrt(ASIDE / abs(bend))) if bend else speed
        return Twist.planar(speed, speed * bend)

    def _turn(self, speed: float, bearing: float) -> Twist:
        most = turn_speed(self.vehicle)
        turn = max(-most, min(most, AIM * bearing))
        if abs(bearing) > BESIDE:
            return Twist.planar(0.0, turn)
        return Twist.planar(speed * cos(bearing), turn)
