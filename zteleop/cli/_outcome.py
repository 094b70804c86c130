"""What became of the commands that a verb said."""

import sys
from math import tan

from zteleop.bus.escape import printable
from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.control import curvature
from zteleop.control.command import IN_VAIN, asks_in_vain, moves
from zteleop.errors import BusError
from zteleop.messages import DriveStatus, Message

ANSWERED_WITHIN = 0.5
"""s to wait for the robot's word on what it did not obey"""
TOLERANCE = 1.001
"""times a bound, beyond which somebody asks for more"""


class Outcome:
    """Whether a robot ever did what was said: it answers who drives, and whom it refuses."""

    def __init__(self, node: Node, publisher: Publisher[Message]) -> None:
        self._node = node
        self._publisher = publisher
        self._moved = False
        self._in_vain = False
        self._obeyed = False
        self._why = ""
        self._told = False
        """It was said that more is asked for than the robot can."""
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
        ours = status.state == "driving" and status.operator == self._publisher.sender
        self._obeyed |= ours
        self._why = f"{status.state}: {status.why}"
        if ours and not self._told and (words := self._beyond(status)):
            self._told = True
            print(printable(f"zteleop pub: {words}"), file=sys.stderr, flush=True)

    def _beyond(self, status: DriveStatus) -> str:
        """Return what is asked for beyond what the robot makes of it; nothing where all of it is within."""
        speed, turn = abs(status.wanted.linear.x), abs(status.wanted.angular.z)
        vehicle = self._node.membership.heard().vehicle
        if speed > TOLERANCE * status.max_speed:
            why = f": {status.slowed}" if status.slowed else ""
            return f"{speed:.3g} m/s are asked for, and it makes {status.max_speed:.3g} at most{why}"
        if vehicle and turn > TOLERANCE * vehicle.max_turn:
            return f"{turn:.3g} rad/s are asked for, and it makes {vehicle.max_turn:.3g} at most"
        if vehicle and vehicle.steers and curvature.rolls(speed):
            lock = speed * tan(vehicle.max_steering_angle) / vehicle.wheelbase
            if turn > TOLERANCE * lock:
                return f"{turn:.3g} rad/s are asked for, and at {speed:.3g} m/s it makes {lock:.2g} at most"
        return ""
