"""Only one may say where a robot is, or what it sees: of two that differ nobody could tell which is right."""

from zteleop.bus import presence
from zteleop.bus.names import Name, resolve
from zteleop.bus.node import Node
from zteleop.cli import _company
from zteleop.errors import DeviceError

SPEAKS_WITHIN = 1.0
"""s in which whoever publishes it is heard"""


def expect_alone(node: Node, topic: str = "odom", what: str = "where {robot} is") -> None:
    """Raise DeviceError where somebody else says on a topic what this node is to say, and not only could."""
    name = resolve(topic, node.robot)
    others = _company.members(name, "pub", presence.endpoints(node.membership.session))
    if others and _is_said(node, name):
        who = ", ".join(sorted({f"{one.node} on {one.process}" for one in others}))
        words = what.format(robot=node.robot)
        raise DeviceError(f"{who} says {words} already; end that, or say --robot NAME")


def _is_said(node: Node, name: Name) -> bool:
    """Say whether it is published now; nobody need know of this short listening."""
    ring = node.membership.session.subscribe(name.key, 1)
    heard: object = node.membership.until(ring.try_recv, SPEAKS_WITHIN)
    ring.undeclare()
    return heard is not None
