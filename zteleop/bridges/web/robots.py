"""Every robot on the bus, what it does and for whom: told to pages that look, and heard for nobody else."""

from zteleop.bridges.web.lookers import Lookers
from zteleop.bridges.web.slots import Slots
from zteleop.bridges.web.words import Robot, Robots, text
from zteleop.bus import clock, codec
from zteleop.bus.names import is_robot
from zteleop.bus.node import Node
from zteleop.bus.session import Sample
from zteleop.control.proof import called
from zteleop.errors import MessageError
from zteleop.messages import DriveStatus

DEPTH = 1000
"""statuses between two looks; of more robots some are seen the next time"""
MOST = 200
"""robots that are told"""
LOOK_EVERY, TELL_EVERY = 0.1, 1.0
"""s"""
SILENT = 2.0
"""s without a status after which a robot is said to be silent, and no more is known of it"""
GONE = 60.0
"""s after which it is no longer said"""
_ACCEPTED = codec.decoders([DriveStatus])


class Fleet:
    """For the node's loop alone."""

    def __init__(self, node: Node) -> None:
        self._lookers = Lookers(node.membership.session, "robot/*/drive_status", DEPTH)
        self._newest: dict[str, tuple[Sample, float]] = {}
        """robot -> what it said last, and when that came"""
        node.every(LOOK_EVERY)(self._look)
        node.every(TELL_EVERY)(self._tell)

    def look(self, page: str, slots: Slots, looks: bool) -> None:
        """Tell a page of all robots from now on, once a second, or no longer."""
        if looks:
            self._lookers.look(page, slots)
        else:
            self.forget(page)

    def forget(self, page: str) -> None:
        """Take in that a page looks no longer, or is gone."""
        self._lookers.forget(page)
        if not self._lookers:
            self._newest.clear()

    def _look(self) -> None:
        now = clock.now()
        for sample in self._lookers.take():
            robot = sample.key.split("/")[1]
            if sample.is_put and is_robot(robot) and (robot in self._newest or len(self._newest) < MOST):
                self._newest[robot] = sample, now

    def _tell(self) -> None:
        if not self._lookers:
            return
        now = clock.now()
        self._newest = {name: last for name, last in self._newest.items() if now - last[1] < GONE}
        robots = [_robot(name, *last, now) for name, last in sorted(self._newest.items())]
        self._lookers.tell("robots", text(Robots(robots)))


def _robot(name: str, sample: Sample, at: float, now: float) -> Robot:
    if now - at > SILENT:
        return Robot(name, "silent", f"it has said nothing for {now - at:.0f} s", "")
    try:
        status = codec.decode(sample.payload, sample.encoding, _ACCEPTED)
    except MessageError:
        return Robot(name, "unknown", "what it says is of another version of zteleop", "")
    assert isinstance(status, DriveStatus)
    operator = called(status.source, status.operator) if status.operator else ""
    return Robot(name, status.state, status.why, operator)
