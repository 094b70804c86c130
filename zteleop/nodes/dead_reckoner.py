"""Says where a robot should be that has nothing else to say so: by what its wheels are told, or turn."""

from collections.abc import Callable
from math import hypot
from typing import Generic, TypeVar

from zteleop.bus import clock, presence
from zteleop.bus.node import Node
from zteleop.bus.topics import TOPICS
from zteleop.control.motion.dead_reckoning import DeadReckoning, OdometrySettings
from zteleop.control.motion.pose import heading_of
from zteleop.control.proof import NEVER
from zteleop.messages import DriveStatus, Imu, Message, Odometry, TFMessage, Twist, WheelTicks

M = TypeVar("M", bound=Message)
SILENT = 0.5
"""s after which what a robot or an IMU said last is over"""
ENCODERS_SILENT = 2.0
"""s after which encoders are; the seldom ones speak once a second"""
HEARD_WITHIN = 1.0
"""s until it tells that nobody is heard"""
UPRIGHT = 0.1
"""by which the length of a rotation may differ from 1"""
FASTEST, TURNS = 20.0, 50.0
"""m/s and rad/s; nothing that is told more than that is driven so"""


class Lately(Generic[M]):
    """What was said last on a topic, and whether it still counts; nonsense is told, and never does."""

    def __init__(
        self,
        node: Node,
        topic: str,
        kind: type[M],
        lasts: float = SILENT,
        nonsense: Callable[[M], str] = lambda message: "",
    ) -> None:
        self._inbox = node.subscription(topic, kind)
        self._topic = topic
        self._warn = node.log.warn
        self._lasts = lasts
        self._nonsense = nonsense
        self.last: M | None = None
        self.at = NEVER

    def news(self, now: float) -> M | None:
        """Return what has come since the look before."""
        news = self._inbox.newest()
        if news and (why := self._nonsense(news)):
            self._warn(f"{self._topic} does not count: {why}", self._topic)
            return None
        if news:
            self.last, self.at = news, now
        return news

    def speaks(self, now: float) -> bool:
        return now - self.at <= self._lasts


def too_fast(status: DriveStatus) -> str:
    """Return why nothing is driven as a status says."""
    speed, turn = status.applied.linear.x, status.applied.angular.z
    sane = abs(speed) <= FASTEST and abs(turn) <= TURNS
    return "" if sane else f"nothing drives at {speed:g} m/s and {turn:g} rad/s"


def no_heading(imu: Imu) -> str:
    """Return why an IMU does not say where it looks: as ROS has it, -1 is for one that does not know."""
    if imu.orientation_covariance[0] == -1:
        return "this imu knows no orientation"
    q = imu.orientation
    length = hypot(q.x, q.y, q.z, q.w)
    return "" if abs(length - 1) <= UPRIGHT else f"a rotation has a length of 1, found {length:g}"


class DeadReckoner:
    """Counts from 0, 0, 0 where it begins; `tell` hears by what, whenever that is something else."""

    def __init__(self, node: Node, settings: OdometrySettings, tell: Callable[[str], object]) -> None:
        self._settings = settings
        self._tell = tell
        self._node = node
        self._began = clock.now()
        self._there: bool | None = None
        self._heard = node.membership.heard()
        self._reckoning = DeadReckoning(settings)
        self._told = Lately(node, "drive_status", DriveStatus, nonsense=too_fast)
        self._ticks = Lately(node, "wheel_ticks", WheelTicks, ENCODERS_SILENT)
        self._compass = Lately(node, "imu", Imu, nonsense=no_heading)
        self._odoms = node.publisher("odom", Odometry)
        self._transforms = node.publisher("tf", TFMessage)
        self._then = clock.now()
        self._goes_by = ""
        node.every(TOPICS["odom"].every)(self.step)

    def step(self) -> None:
        """Take in what came, and say where it is now."""
        now = clock.now()
        self._look(now)
        self._roll(now, now - self._then)
        self._then = now
        if not self._notice_robot(now):
            return  # of one who is gone nobody knows where it is
        self._say(now)
        stamp = clock.stamp()
        self._odoms.publish(self._reckoning.odometry(stamp))
        self._transforms.publish(TFMessage([self._reckoning.transform(stamp)]))

    def _notice_robot(self, now: float) -> bool:
        """Return whether the robot is heard; tell when that changes, and where it never was."""
        there = self._told.speaks(now) or self._ticks.speaks(now)
        if there or self._there or now - self._began > HEARD_WITHIN:
            self._tell_of(there)
        return there

    def _tell_of(self, there: bool) -> None:
        robot = self._node.robot or ""
        if there and self._there is False:
            self._node.log.info(f"robot {robot} is heard")
        elif not there and self._there is not False:
            more = " any more" if self._there else ""
            here = presence.here(self._node.membership.session, robot)
            self._node.log.warn(f"robot {robot} is not heard{more}, and where it is not said; {here}")
        self._there = there

    def _roll(self, now: float, dt: float) -> None:
        """Go on by the wheels' encoders where they speak, else by what the wheels are told."""
        self._told.news(now)
        if vehicle := self._heard.vehicle:
            self._reckoning.steers = vehicle.steers
        spoke, counted = self._ticks.speaks(now), self._ticks.at
        if self._settings.wheels == "ticks" and (ticks := self._ticks.news(now)):
            self._reckoning.count(ticks.ticks_left, ticks.ticks_right, now - counted if spoke else 0.0)
        elif not spoke:
            told = self._told.last if self._told.speaks(now) else None
            self._reckoning.obey(told.applied if told else Twist.zero(), dt)

    def _look(self, now: float) -> None:
        """Take the heading from an IMU while it speaks."""
        if self._settings.imu and (imu := self._compass.news(now)):
            self._reckoning.look(heading_of(imu.orientation))
        elif not self._compass.speaks(now):
            self._reckoning.forget_compass()

    def _say(self, now: float) -> None:
        wheels = "the encoders of its wheels" if self._ticks.speaks(now) else "what its wheels are told"
        compass = ", and the heading of its IMU" if self._compass.speaks(now) else ""
        if (goes_by := f"{wheels}{compass}") != self._goes_by:
            self._goes_by = goes_by
            self._tell(goes_by)
