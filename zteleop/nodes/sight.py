"""What an operator's process sees of the robot it drives."""

from zteleop.bus.node import Node
from zteleop.control.deadlines import LINK_LOSS
from zteleop.control.hold import HOLDS
from zteleop.messages import DriveStatus, Log, Odometry, Vehicle, WatchdogStatus
from zteleop.screen.view import Unmanned

OWN = ("watchdog", "actuator", "blackbox", "sim")
"""The robot's processes; what other operators' programs complain of is theirs to read."""
REFUSED = " is refused: "
NEWS = 10.0
"""s that a line of the log is shown; what it says may be over by then"""
SILENT = 0.4
"""s without a beat, of twenty a second, after which what was said last may not be so any more"""
ODOM_LASTS = 0.5
"""s after which nobody knows where it is"""
LOST = "the robot was not ready for what was pressed, and has dropped it: press again"
ANEW = "the robot was started anew; whoever drove must begin anew as well"


def _unmanned(dog: WatchdogStatus, robot: str) -> Unmanned | None:
    if dog.state == "ended":
        return Unmanned("ended", f"{dog.why}; `zteleop actuator --robot {robot}` starts it again")
    if dog.state == "resting":
        return Unmanned("restarting", f"{dog.why}; the chip is kept at rest, and another starts")
    return None


class Sight:
    """One robot: whether it is heard, is the same, rests, and what it says of itself."""

    def __init__(self, node: Node) -> None:
        self._robot = node.robot or ""
        self._heard = node.membership.heard()
        self._statuses = node.subscription("drive_status", DriveStatus)
        self._odoms = node.subscription("odom", Odometry)
        self._logs = node.subscription("log", Log)
        self._watchdogs = node.subscription("watchdog", WatchdogStatus)
        self.news: DriveStatus | None = None
        """The status that came since the look before."""
        self.status: DriveStatus | None = None
        """None when no actuator is heard"""
        self.unmanned: Unmanned | None = None
        """What its watchdog says, while it has no actuator."""
        self._status_at = float("-inf")
        self._epoch: int | None = None
        self._at_rest = False
        self._odom: tuple[Odometry | None, float] = (None, float("-inf"))
        """where it was last, and when it said so"""
        self._log = ("", float("-inf"))
        """its latest warning, and when that came"""

    def look(self, now: float) -> bool:
        """Take in what came; True where whoever acts must begin anew.

        That is so when the robot is another one than before (restarted, or long unheard), when it is
        kept at rest, and when that ends.
        """
        self.news = self._statuses.newest()
        if self.news:
            if self.status and self.news.state != self.status.state and self._is_over(self.news):
                self._log = ("", now)
            self.status, self._status_at = self.news, now
            self.unmanned = None
        elif now - self._status_at > LINK_LOSS:
            self.status = None
        if dog := self._watchdogs.newest():
            self.unmanned = _unmanned(dog, self._robot)
            if self.unmanned and REFUSED in self._log[0]:
                self._log = ("", now)
        beat = self._heard.beat
        gone = beat is None or now - self._heard.at > LINK_LOSS
        if beat and self._epoch not in (None, beat.epoch):
            self._log = (ANEW, now)
        before = self._epoch, self._at_rest
        self._epoch = None if beat is None or gone else beat.epoch
        self._at_rest = self.status is not None and self.status.state in HOLDS
        return before != (self._epoch, self._at_rest)

    def note_loss(self, now: float) -> None:
        """Take note that what was asked for is lost with this change; of a stop the robot says so itself."""
        if self.status is None or self.status.state not in ("stopped", "fault"):
            self._log = (LOST, now)

    def _is_over(self, status: DriveStatus) -> bool:
        """Say whether what the log told last is so no more: whatever was in the way, or a refusal."""
        return status.state == "driving" or REFUSED in self._log[0]

    @property
    def vehicle(self) -> Vehicle | None:
        """What it last said it is."""
        return self._heard.vehicle

    def silence(self, now: float) -> float:
        """Return for how long it has said nothing, in s; 0 while that is no matter, or nobody is heard."""
        silence = now - max(self._status_at, self._heard.at)
        return silence if self.status and silence > SILENT else 0.0

    def odom(self, now: float) -> Odometry | None:
        """Return where it said that it is; None when nobody says so any more."""
        if newest := self._odoms.newest():
            self._odom = newest, now
        elif now - self._odom[1] > ODOM_LASTS:
            self._odom = None, self._odom[1]
        return self._odom[0]

    @property
    def odom_lost(self) -> bool:
        """Whether it said where it is, and does so no more."""
        return self._odom[0] is None and self._odom[1] > float("-inf")

    def log(self, now: float) -> str:
        """Return its latest warning, while it is news; all else the status says better."""
        for said in self._logs.take():
            if said.message.name in OWN and said.message.level >= Log.WARN:
                words = said.message.msg
                if REFUSED in words:
                    words = words.partition("; ")[0]  # the advice is for whoever was refused
                self._log = (f"{said.message.name}: {words}", now)
        words, at = self._log
        return words if now - at < NEWS else ""
