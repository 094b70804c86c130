"""Asks a robot to stop, or to end its stop, until the robot shows that it did."""

import getpass
import secrets
import socket
from typing import Literal

from zteleop.bus.node import Node
from zteleop.control.hold import HOLDS
from zteleop.messages import DriveStatus, Stop

EVERY, PATIENCE = 0.05, 2.0
NEVER = float("-inf")
_ID_BITS = 53  # what every JSON reader can count
_LONGEST = 200
"""Characters of `by` and `why`; readers drop what is longer, and with it the stop."""


class Stopping:
    """One stop or one release at a time, said 20 times a second until `drive_status` shows it."""

    def __init__(self, node: Node, by: str) -> None:
        self._robot, self._by = node.robot or "", by
        self._publisher = node.publisher("stop", Stop)
        self._matched = False
        self._asked = Stop.zero()
        self._since = self._due = NEVER
        self._seen: DriveStatus | None = None
        self._before: DriveStatus | None = None
        """The status at the press: a stop that it shows is none that came later."""
        self._since_then: DriveStatus | None = None
        self.state: Literal["", "pending", "done", "failed"] = ""
        self.words = ""
        self.ended = NEVER

    @property
    def unanswered(self) -> bool:
        """A stop was asked for, and nobody knows whether it is in force."""
        return self.state == "failed" and self._asked.engaged

    def engage(self, now: float, why: str = "") -> None:
        """Begin to ask for a stop, under an id of its own."""
        self._before = self._seen
        self._ask(Stop(True, 1 + secrets.randbelow(2**_ID_BITS - 1), _sayable(self._by), _sayable(why)), now)
        self.words = f"asking {self._robot} to stop"

    def release(self, status: DriveStatus | None, now: float) -> None:
        """Begin to ask for the end of the stop that a status shows; never of one that nobody has seen."""
        stopped = status is not None and status.state == "stopped"
        if self.state == "pending" and (self._asked.engaged or status is None) and not stopped:
            return  # what is asked for comes first
        if status is None:
            self._asked = Stop.zero()
            self._end("failed", f"{self._robot} is not heard, so nothing is released; is it on?", now)
        elif not stopped:
            self._asked = Stop.zero()
            self._end("done", f"{self._robot} is not stopped", now)
        elif self.state != "pending" or self._asked.engaged or self._asked.id != status.stop:
            self._ask(Stop(False, status.stop, _sayable(self._by), ""), now)
            self.words = f"asking {self._robot} to end its stop"

    def heed(self, status: DriveStatus | None, now: float) -> bool:
        """Take in a new status, if there is one, and go on asking; True when nothing is asked any more."""
        self._seen, self._since_then = status or self._seen, status or self._since_then
        if self.state == "pending":
            self._go_on(status, now)
        elif self.unanswered and status and status.state == "stopped" and status.stop == self._asked.id:
            self._end("done", f"{self._robot} is stopped (acknowledged late)", now)
        return self.state != "pending"

    def _ask(self, said: Stop, now: float) -> None:
        self.state, self._asked, self._since = "pending", said, now
        self._since_then = None
        self._say(now)

    def _say(self, now: float) -> None:
        self._matched, self._due = self._publisher.matched, now + EVERY
        self._publisher.publish(self._asked)

    def _go_on(self, status: DriveStatus | None, now: float) -> None:
        if status and self._asked.engaged:
            self._look_for_stop(status, now)
        elif status:
            self._look_for_release(status, now)
        if self.state != "pending":
            return
        if now - self._since >= PATIENCE:
            self._give_up(now)
        elif now >= self._due or (self._publisher.matched and not self._matched):
            self._say(now)  # at the first listener at once: what was said before went nowhere

    def _look_for_stop(self, status: DriveStatus, now: float) -> None:
        self._before = self._before or status
        if status.state != "stopped":
            return
        if status.stop == self._asked.id:
            self._end("done", f"{self._robot} is stopped{self._took(now)}", now)
        elif self._before.state != "stopped" or self._before.stop != status.stop:
            self._end("done", f"{self._robot} is stopped, by somebody else as well{self._took(now)}", now)

    def _look_for_release(self, status: DriveStatus, now: float) -> None:
        if status.state == "stopped" and status.stop != self._asked.id:
            self._end("failed", f"{self._robot} was stopped anew meanwhile: {status.why}", now)
        elif status.state in HOLDS and status.state != "stopped":
            self._end("done", f"the stop of {self._robot} is over, but it is kept at rest: {status.why}", now)
        elif status.state != "stopped":
            self._end("done", f"{self._robot} may drive again, from neutral{self._took(now)}", now)

    def _give_up(self, now: float) -> None:
        """Say what to do now; a robot that another's older stop keeps at rest is stopped all the same."""
        seen = self._since_then
        if self._asked.engaged and seen and seen.state == "stopped":
            what = "is stopped, but not by this stop, which it has not acknowledged"
            self._end("done", f"{self._robot} {what}: {seen.why}", now)
        elif self._asked.engaged:
            what = f"has not acknowledged the stop within {PATIENCE:g} s"
            self._end("failed", f"{self._robot} {what}: cut its power, or run zteleop neutral on it", now)
        else:
            what = f"has not acknowledged the release within {PATIENCE:g} s"
            self._end("failed", f"{self._robot} {what}; take it as stopped, and try again", now)

    def _took(self, now: float) -> str:
        return f" (acknowledged within {max(1.0, (now - self._since) * 1000):.0f} ms)"

    def _end(self, state: Literal["done", "failed"], words: str, now: float) -> None:
        self.state, self.words, self.ended = state, words, now


def person() -> str:
    """Return who asks, as user@host."""
    try:
        user = getpass.getuser()
    except (KeyError, OSError):
        user = "somebody"
    return f"{user}@{socket.gethostname()}"


def _sayable(text: str) -> str:
    """Return what surely arrives: a stop must not fail for its words."""
    return text[:_LONGEST].encode("utf-8", "replace").decode()
