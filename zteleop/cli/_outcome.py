"""What became of the commands that a verb said."""

import sys
from typing import TypeVar

from zteleop.bus import clock, presence
from zteleop.bus.escape import printable
from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.control.command import IN_VAIN, asks_in_vain, moves
from zteleop.control.proof import NEVER
from zteleop.errors import BusError
from zteleop.messages import DriveStatus, Message

M = TypeVar("M", bound=Message)

HEARD_WITHIN = 3.0
"""s to wait for somebody who hears a topic"""
TELL_AFTER = 1.0
"""s of that until it says for whom it waits"""
ANSWERED_WITHIN = 0.5
"""s to wait for the robot's word on what it did not obey"""
SAID = "limits.speed "
"""how a reason begins of which whoever publishes is told"""
TOLERANCE = 1.001
"""times a bound, beyond which somebody asks for more"""


def await_robot(verb: str, node: Node, publisher: Publisher[M]) -> bool:
    """Wait until the robot that a command proves its age to has started; BusError when it does not answer."""
    heard = node.membership.heard()

    def answers() -> bool:
        return publisher.matched and heard.beat is not None

    if not node.membership.until(answers, TELL_AFTER):
        here = presence.here(node.membership.session, node.robot)
        print(printable(f"zteleop {verb}: waits for {node.robot}; {here}"), file=sys.stderr, flush=True)
        if not node.membership.until(answers, HEARD_WITHIN - TELL_AFTER):
            raise BusError(f"robot {node.robot} does not answer; is its actuator on? {here}")
    heard.wait(lambda: None)  # it is there: only its start may not be over
    return True


class Outcome:
    """Whether a robot ever did what was said: it answers who drives, and whom it refuses."""

    def __init__(self, verb: str, node: Node, publisher: Publisher[M]) -> None:
        self._verb = verb
        self._node = node
        self._publisher = publisher
        self._moved = False
        self._in_vain = False
        self.obeyed = False
        """It was, at least once."""
        self.status: DriveStatus | None = None
        """what the robot said last"""
        self.heard_at = NEVER
        self._told = False
        """It was said that more is asked for than the robot may do now."""
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
        self._node.membership.until(lambda: self.obeyed or self._publisher.refused, ANSWERED_WITHIN)
        if not self.obeyed:
            raise BusError(f"nothing of it was obeyed: {self._publisher.refused or self._why}")

    @property
    def lost(self) -> str:
        """Why the robot that obeyed does so no more; empty while it does, or never did."""
        return "" if self._is_ours or not self.obeyed else self._publisher.refused or self._why

    @property
    def is_taken(self) -> bool:
        """Somebody else drives, or has stopped it."""
        return bool(self.status and self.status.state in ("driving", "stopped") and not self._is_ours)

    @property
    def _why(self) -> str:
        return f"{self.status.state}: {self.status.why}" if self.status else ""

    @property
    def _is_ours(self) -> bool:
        status = self.status
        return bool(status and status.state == "driving" and status.operator == self._publisher.sender)

    def _heed(self, status: DriveStatus) -> None:
        self.status, self.heard_at = status, clock.now()
        self.obeyed |= self._is_ours
        if self._is_ours and not self._told and (words := self._slowed(status)):
            self._told = True
            print(printable(f"zteleop {self._verb}: {words}"), file=sys.stderr, flush=True)

    def _slowed(self, status: DriveStatus) -> str:
        """Return what keeps the robot from a speed that it could do; what it cannot, its publisher says."""
        speed = abs(status.wanted.linear.x)
        if not status.slowed or status.slowed.startswith(SAID) or speed <= TOLERANCE * status.max_speed:
            return ""
        return f"{speed:.3g} m/s are asked for, and it makes {status.max_speed:.3g} at most: {status.slowed}"
