"""Only one may say where a robot is: of two that differ nobody could tell which is right."""

from zteleop.bus import presence
from zteleop.bus.names import resolve
from zteleop.bus.node import Node
from zteleop.cli import _company
from zteleop.errors import DeviceError

SPEAKS_WITHIN = 1.0
"""s in which whoever publishes it is heard"""


def expect_alone(node: Node) -> None:
    """Raise DeviceError where somebody else says where the robot is, and not only could."""
    endpoints = presence.endpoints(node.membership.session)
    others = _company.members(resolve("odom", node.robot), "pub", endpoints)
    if others and _is_said(node):
        who = ", ".join(sorted({f"{one.node} on {one.process}" for one in others}))
        raise DeviceError(f"{who} says where {node.robot} is already; end that, or say --robot NAME")


def _is_said(node: Node) -> bool:
    """Say whether it is published now; nobody need know of this short listening."""
    ring = node.membership.session.subscribe(resolve("odom", node.robot).key, 1)
    heard: object = node.membership.until(ring.try_recv, SPEAKS_WITHIN)
    ring.undeclare()
    return heard is not None
