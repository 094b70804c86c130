"""Only one may say where a robot is: of two that differ nobody could tell which is right."""

from zteleop.bus import presence
from zteleop.bus.names import resolve
from zteleop.bus.node import Node
from zteleop.cli import _company
from zteleop.errors import DeviceError
from zteleop.messages import Odometry

SPEAKS_WITHIN = 1.0
"""s in which whoever publishes it is heard"""


def expect_alone(node: Node) -> None:
    """Raise DeviceError where somebody else says where the robot is, and not only could."""
    endpoints = presence.endpoints(node.membership.session)
    others = _company.members(resolve("odom", node.robot), "pub", endpoints)
    odoms = node.subscription("odom", Odometry)
    heard = node.membership.until(odoms.newest, SPEAKS_WITHIN) if others else None
    if heard:
        who = ", ".join(sorted({f"{one.node} on {one.process}" for one in others}))
        raise DeviceError(f"{who} says where {node.robot} is already; end that, or say --robot NAME")
