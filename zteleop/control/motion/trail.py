"""What a motion came to, as odometry saw it: the way, the turn, the radius, the end."""

from math import cos, remainder, sin, tau

from zteleop.control.motion.arc import fit_circle
from zteleop.control.motion.pose import Pose2D

ROUND = 0.5
"""rad turned, before and after which a circle is begun and ended and not yet one"""

MOVED = 0.005
"""m or rad that are more than noise"""


class Trail:
    """Poses in the order they were heard, each with its time in s."""

    def __init__(self) -> None:
        self._poses: list[tuple[float, Pose2D]] = []
        self._turns: list[float] = []
        self._moved: tuple[Pose2D, float, float, float] | None = None
        """The last pose noted, its turn, when it was, and when the first move began."""
        self.way = 0.0
        """m that base_link moved"""
        self.ahead = 0.0
        """m of it that it moved to the front, less what it moved to the back"""

    def __bool__(self) -> bool:
        return len(self._poses) > 1

    def add(self, pose: Pose2D, now: float) -> None:
        """Take in the next pose."""
        turned = 0.0
        if self._poses:
            _, before = self._poses[-1]
            self.way += before.distance(pose.x, pose.y)
            x, y = pose.x - before.x, pose.y - before.y
            self.ahead += x * cos(before.heading) + y * sin(before.heading)
            turned = self.turned + remainder(pose.heading - before.heading, tau)
            self._notice(pose, turned, now)
        self._poses.append((now, pose))
        self._turns.append(turned)

    def _notice(self, pose: Pose2D, turned: float, now: float) -> None:
        """Note a pose that is clearly another than the last one noted."""
        before, its_turn, _, _ = self._moved or (self.start, 0.0, now, now)
        if before.distance(pose.x, pose.y) > MOVED or abs(turned - its_turn) > MOVED:
            self._moved = (pose, turned, now, self._moved[3] if self._moved else self._poses[-1][0])

    @property
    def is_nowhere(self) -> bool:
        """It has neither moved nor turned by more than noise."""
        return self._moved is None

    @property
    def turned(self) -> float:
        """rad since the start, to the left, whole turns included."""
        return self._turns[-1] if self._turns else 0.0

    @property
    def seconds(self) -> float:
        """s from the first move to the last."""
        return self._moved[2] - self._moved[3] if self._moved else 0.0

    def stood(self, now: float) -> float:
        """Return for how many s it has not moved; 0 where nobody saw it."""
        if not self._poses:
            return 0.0
        return now - (self._moved[2] if self._moved else self._poses[0][0])

    @property
    def start(self) -> Pose2D:
        return self._poses[0][1]

    @property
    def end(self) -> Pose2D:
        return self._poses[-1][1]

    def radius(self) -> float | None:
        """Return the radius, m, of the circle it went round once it was going; None where it was none."""
        first, last = sorted((0.0, self.turned))
        margin = min(ROUND, (last - first) / 4)
        points = [
            (pose.x, pose.y)
            for (_, pose), turned in zip(self._poses, self._turns, strict=True)
            if first + margin <= turned <= last - margin
        ]
        circle = fit_circle(points)
        return abs(circle.radius) if circle else None
