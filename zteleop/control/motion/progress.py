"""Whether a robot does what it is told, or stands before something."""

from zteleop.control.motion.trail import Trail
from zteleop.messages import Twist

STUCK, LEAST = 3.0, 0.05
"""s in which a robot that is told to move has to move, and which share of what it is told"""


class Progress:
    """What was asked of a robot since it last did enough of it: m along its way, and rad on the spot."""

    def __init__(self) -> None:
        self._way = 0.0
        self._turn = 0.0
        self._from: tuple[float, float, float] | None = None

    @property
    def is_asked(self) -> bool:
        """It was told to move, lately."""
        return self._way > 0 or self._turn > 0

    def ask(self, twist: Twist, seconds: float) -> None:
        """Note what it is told to do for some time."""
        self._way += abs(twist.linear.x) * seconds
        self._turn += abs(twist.angular.z) * seconds if twist.linear.x == 0 else 0.0

    def is_stuck(self, trail: Trail, now: float) -> bool:
        """Say whether it did too little of it for too long."""
        began, way, turned = self._from or (now, trail.way, trail.turned)
        self._from = began, way, turned
        done = trail.way - way >= LEAST * self._way and abs(trail.turned - turned) >= LEAST * self._turn
        if now - began <= STUCK:
            return False
        self._way = self._turn = 0.0
        self._from = now, trail.way, trail.turned
        return not done
