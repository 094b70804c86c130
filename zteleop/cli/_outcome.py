"""What became of the commands that a verb said."""

from zteleop.bus.answer import IN_VAIN
from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.control.command import asks_in_vain, moves
from zteleop.errors import BusError
from zteleop.messages import DriveStatus, Message

ANSWERED_WITHIN = 0.5
"""s to wait for the robot's word on what it did not obey"""


class Outcome:
    """Whether a robot ever did what was said: it answers who drives, and whom it refuses."""

    def __init__(self, node: Node, publisher: Publisher[Message]) -> None:
        self._node = node
        self._publisher = publisher
        self._moved = False
        self._in_vain = False
        self._obeyed = False
        self._why = ""
        node.subscription("drive_status", DriveStatus, lambda received: self._heed(received.message))

    def note(self, message: Message) -> None:
        """Remember that something was asked for that moves."""
        self._moved |= moves(message, self._node.membership.heard().vehicle)
        self._in_vain |= asks_in_vain(message)

    def check(self) -> None:
        """Raise BusError where it did nothing of that; wait a moment for its word."""
        if not self._moved and self._in_vain:
            raise BusError(f"nothing of it moves a robot: {IN_VAIN}")
        if not self._moved:
            return
        self._node.membership.until(lambda: self._obeyed or self._publisher.refused, ANSWERED_WITHIN)
        if not self._obeyed:
            raise BusError(f"nothing of it was obeyed: {self._publisher.refused or self._why}")

    def _heed(self, status: DriveStatus) -> None:
        self._obeyed |= status.state == "driving" and status.operator == self._publisher.sender
        self._why = f"{status.state}: {status.why}"
