"""Says where a robot should be that has nothing else to say so: by what its wheels are told, or turn."""

from collections.abc import Callable
from typing import Generic, TypeVar

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.subscription import Subscription
from zteleop.bus.topics import TOPICS
from zteleop.control.motion.dead_reckoning import DeadReckoning, OdometrySettings
from zteleop.control.motion.pose import heading_of
from zteleop.messages import DriveStatus, Imu, Message, Odometry, TFMessage, Twist, WheelTicks

M = TypeVar("M", bound=Message)
SILENT = 0.5
"""s after which what a robot, an encoder or an IMU said last is over"""


class Lately(Generic[M]):
    """What was said last on a topic, and whether it still counts."""

    def __init__(self, inbox: Subscription[M]) -> None:
        self._inbox = inbox
        self.last: M | None = None
        self.at = float("-inf")

    def news(self, now: float) -> M | None:
        """Return what has come since the look before."""
        if news := self._inbox.newest():
            self.last, self.at = news, now
        return news

    def speaks(self, now: float) -> bool:
        return now - self.at <= SILENT


class DeadReckoner:
    """Counts from 0, 0, 0 where it begins; `tell` hears by what, whenever that is something else."""

    def __init__(self, node: Node, settings: OdometrySettings, tell: Callable[[str], object]) -> None:
        self._settings = settings
        self._tell = tell
        self._heard = node.membership.heard()
        self._reckoning = DeadReckoning(settings)
        self._told = Lately(node.subscription("drive_status", DriveStatus))
        self._ticks = Lately(node.subscription("wheel_ticks", WheelTicks))
        self._compass = Lately(node.subscription("imu", Imu))
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
        self._say(now)
        stamp = clock.stamp()
        self._odoms.publish(self._reckoning.odometry(stamp))
        self._transforms.publish(TFMessage([self._reckoning.transform(stamp)]))

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
