"""What time of day a node has: nothing is decided by it, but whoever reads a recording should know."""

from collections.abc import Iterable
from typing import NamedTuple

from zteleop.bus import clock
from zteleop.bus.names import Name
from zteleop.bus.presence import Member
from zteleop.bus.service import call
from zteleop.bus.session import Session
from zteleop.errors import BusError
from zteleop.messages import GetTimeRequest, GetTimeResponse, Time

SERVICE, TYPE = "get_time", "zteleop_msgs/srv/GetTime"
ANSWERED_WITHIN = 1.0
AT_ONCE = 8
"""nodes that are asked at a time"""


class Offset(NamedTuple):
    """How far a node's time of day is ahead of this machine's."""

    node: Member
    seconds: float | None
    """None: it did not answer; exact to half the way there and back"""


def tell(asked: GetTimeRequest) -> GetTimeResponse:
    """Answer whoever asks a node."""
    return GetTimeResponse(clock.stamp())


def offsets(session: Session, nodes: Iterable[Member]) -> list[Offset]:
    """Ask each node what time it has; each has a second to answer."""
    from concurrent.futures import ThreadPoolExecutor  # not each node's start

    with ThreadPoolExecutor(AT_ONCE) as asking:
        return list(asking.map(lambda node: Offset(node, _offset(session, node)), nodes))


def _offset(session: Session, node: Member) -> float | None:
    name = Name(node.robot, f"{node.node}/{SERVICE}")
    before = _seconds(clock.stamp())
    try:
        told = call(session, name, GetTimeRequest(), GetTimeResponse, ANSWERED_WITHIN)
    except BusError:
        return None
    return _seconds(told.stamp) - (before + _seconds(clock.stamp())) / 2


def _seconds(stamp: Time) -> float:
    return stamp.sec + stamp.nanosec * 1e-9
