"""Asks a robot to stop, or to end its stop, until the robot shows that it did."""

import getpass
import socket
from collections.abc import Sequence
from typing import Literal

from zteleop.bus.lane.call import Call
from zteleop.bus.lane.wire import Answered
from zteleop.bus.node import Node
from zteleop.control.evidence import STANDS
from zteleop.control.hold import HOLDS
from zteleop.control.proof import NEVER
from zteleop.control.stop import MERGED, is_persons, whose
from zteleop.machine.ids import new_id
from zteleop.messages import Confirmed, DriveStatus, Stop
from zteleop.nodes.stop_ways import Ways

ACKNOWLEDGED_WITHIN = 2.0
REPEAT = 3.0
"""s for which a stop is said, also after the answer: longer than any loss of the link that heals by itself"""
SETTLED = 0.5
"""s since a stop was heard, after which whoever waits is told what chip and disk have not confirmed"""
_LONGEST = 200
"""Characters of `by` and `why`; readers drop what is longer, and with it the stop."""


class Stopping:
    """One stop or one release at a time, said 20 times a second until `drive_status` shows it."""

    def __init__(self, node: Node | None, by: str, robot: str = "", lane: Call | None = None) -> None:
        self.robot = robot
        self._by = _sayable(by)
        self._ways = Ways(lane)
        if node:
            self.join(node)
        self._asked: list[Stop] = []
        self._since = NEVER
        self._before: frozenset[int] | None = None
        """The stops that were in force when it was asked, as far as anybody has seen."""
        self._seen: DriveStatus | None = None
        self._since_then: DriveStatus | None = None
        self._heard = NEVER
        """When the robot first said that it has heard the stop asked for."""
        self._shown = False
        """A status has shown it."""
        self.is_over = False
        """The stop asked for was acknowledged, and is no longer in force."""
        self.state: Literal["", "pending", "done", "failed"] = ""
        self.words = ""
        self.ended = NEVER

    def join(self, node: Node) -> None:
        """Say on the bus as well what has only been said on the lane so far."""
        self._ways.join(node, self.robot)
        self.robot = self.robot or node.robot or ""

    @property
    def unanswered(self) -> bool:
        """A stop was asked for, and nobody knows whether the robot stands."""
        return self.state == "failed" and self._engages

    @property
    def unheard(self) -> bool:
        """The robot has never said anything."""
        return self._seen is None

    def repeats(self, now: float) -> bool:
        """Say whether a stop is still being said, whatever the answer was."""
        return self._engages and not self.is_over and now - self._since < REPEAT

    def engage(self, now: float, why: str = "") -> None:
        """Begin to ask for a stop, under an id of its own."""
        self._ask([Stop(True, new_id(), self._by, _sayable(why))], now)
        self.words = f"asking {self.robot} to stop"

    def release(self, status: DriveStatus | None, now: float, everybodys: bool = False) -> None:
        """Begin to ask for the end of one's own stops that a status shows, or of everybody's."""
        self._seen = status or self._seen
        stops = status.stops if status else []
        if self.state == "pending" and (self._engages or status is None) and not stops:
            return  # what is asked for comes first
        meant = [stop for stop in stops if everybodys or self._may_release(stop)]
        if status is None:
            self._refuse("failed", f"{self.robot} is not heard, so nothing is released", now)
        elif not stops:
            self._refuse("done", f"{self.robot} is not stopped", now)
        elif not meant:
            self._refuse("failed", self._tell_whose(stops), now)
        elif self.state != "pending" or _ids(self._asked) != _ids(meant) or self._engages:
            self._ask([Stop(False, stop.id, self._by, "") for stop in meant], now)
            self.words = f"asking {self.robot} to end its stop"

    def heed(self, status: DriveStatus | None, now: float) -> bool:
        """Take in a new status, if there is one, and go on asking; True when nothing is asked any more."""
        self._seen = status or self._seen
        self._since_then = status or self._since_then
        if status and self._before is None:  # where none was seen at the press, the first may be older
            self._before = _ids(status.stops)
        if status and self._engages and self._shown:
            self.is_over |= not self._shows(status)
        self.is_over |= self.state != "pending" and status is not None and status.state == "driving"
        if self.state == "pending":
            self._go_on(status, now)
        elif self.unanswered and status and not self.repeats(now) and not status.stops:
            words = (
                f"{self.robot} is heard again, and not stopped: that stop never reached it; press once more"
            )
            self._refuse("failed", words, now)
        elif self.unanswered and status and self._shows(status):
            self._hear(status, now)
        if (self.state == "pending" or self.repeats(now)) and self._ways.is_due(now):
            self._ways.say(self.robot, self._asked, now)
        return self.state != "pending"

    def listen(self, now: float) -> None:
        """Take in what is answered on a lane that is this request's alone."""
        for answer in self._ways.answers() if self._engages else ():  # a look that costs each key some 50 us
            self.hear_lane(answer, now)

    def hear_lane(self, answer: Answered, now: float) -> None:
        """Take in what the robot answers without zenoh; whichever answer comes first is believed."""
        mine = self._engages and answer.robot == self.robot and answer.id == self._asked[0].id
        if not (mine and answer.held and (self.state == "pending" or self.unanswered)):
            return
        self._heard = now if self._heard == NEVER else self._heard
        settled = now - self._heard >= SETTLED
        if answer.confirmed and (settled or not answer.unkept):
            self._end("done", self._stands(answer.confirmed, answer.unkept, now), now)
        elif settled and not self._shown:
            self._fail_unseen(f" ({answer.trouble})" if answer.trouble else "", now)

    @property
    def _engages(self) -> bool:
        return bool(self._asked) and self._asked[0].engaged

    def _may_release(self, stop: Stop) -> bool:
        return stop.by == self._by or (not is_persons(stop) and stop.id != MERGED.id)

    def _tell_whose(self, stops: Sequence[Stop]) -> str:
        return (
            f"{self.robot} is stopped by {whose(stops)}; each releases their own, "
            f"zteleop stop --release --all {self.robot} everybody's"
        )

    def _refuse(self, state: Literal["done", "failed"], words: str, now: float) -> None:
        self._asked = []
        self._end(state, words, now)

    def _ask(self, said: list[Stop], now: float) -> None:
        self._before = _ids(self._seen.stops) if self._seen else None
        self._asked = said
        self._since = now
        self._since_then = None
        self._heard = NEVER
        self._shown = False
        self.is_over = False
        self.state = "pending"
        self._ways.say(self.robot, said, now)

    def _go_on(self, status: DriveStatus | None, now: float) -> None:
        if status and self._engages and self._shows(status):
            self._hear(status, now)
        elif status and not self._engages and not _ids(status.stops) & _ids(self._asked):
            self._find_rest(status, now)
        elif now - self._since >= ACKNOWLEDGED_WITHIN:
            self._give_up(now)

    def _hear(self, status: DriveStatus, now: float) -> None:
        """Say that it is stopped, once the chip shows it and the disk has it, or that they do not."""
        self._heard = now if self._heard == NEVER else self._heard
        self._shown = True
        settled = now - self._heard >= SETTLED
        if status.confirmed and (settled or not status.unkept):
            self._end("done", self._stands(status.confirmed, status.unkept, now), now)
        elif settled:
            self._fail_unseen(f" ({status.why})" if status.state == "fault" else "", now)

    def _stands(self, confirmed: Confirmed, unkept: str, now: float) -> str:
        """Say how the robot is known to stand, and what whoever presses must know of its disk."""
        seen = f"{STANDS[confirmed]}{', late' if self.unanswered else f' {self._within(now)}'}"
        kept = f", but only until it restarts: {unkept}" if unkept else ""
        return f"{self.robot} is stopped ({seen}){kept}"

    def _fail_unseen(self, cause: str, now: float) -> None:
        words = f"{self.robot} heard the stop, {STANDS['']}{cause}"
        if words != self.words:
            self._end("failed", words, now)

    def _shows(self, status: DriveStatus) -> bool:
        """Say whether a stop is in force: by its id, or by what has taken its place."""
        before = self._before or ()
        return any(
            stop.id in (self._asked[0].id, MERGED.id) or (stop.by == self._by and stop.id not in before)
            for stop in status.stops
        )

    def _find_rest(self, status: DriveStatus, now: float) -> None:
        """Say what keeps the robot at rest when the stops that were meant are over."""
        if _ids(status.stops) - (self._before or frozenset()):
            self._end("failed", f"{self.robot} was stopped anew meanwhile: {status.why}", now)
        elif status.stops:
            self._end("done", f"yours is released, but {self._tell_whose(status.stops)}", now)
        elif status.state in HOLDS:
            self._end("done", f"the stop of {self.robot} is over, but it is kept at rest: {status.why}", now)
        else:
            self._end(
                "done", f"{self.robot} may drive again, from neutral (acknowledged {self._within(now)})", now
            )

    def _give_up(self, now: float) -> None:
        """Say what to do now."""
        seen = self._since_then
        if not self._engages:
            what = f"has not acknowledged the release within {ACKNOWLEDGED_WITHIN:g} s"
            self._end("failed", f"{self.robot} {what}; take it as stopped, and try again", now)
            return
        if self._heard > NEVER:
            self._fail_unseen(", and is no longer heard", now)
            return
        what = f"has not acknowledged the stop within {ACKNOWLEDGED_WITHIN:g} s"
        others = f", and rests only by that of {whose(seen.stops)}" if seen and seen.stops else ""
        advice = f"cut its power, or run zteleop neutral --robot {self.robot} on it"
        self._end("failed", f"{self.robot} {what}{others}: {advice}", now)

    def _within(self, now: float) -> str:
        return f"within {max(1.0, (now - self._since) * 1000):.0f} ms"

    def _end(self, state: Literal["done", "failed"], words: str, now: float) -> None:
        self.state = state
        self.words = words
        self.ended = now


def person() -> str:
    """Return who asks, as user@host."""
    try:
        user = getpass.getuser()
    except (KeyError, OSError):
        user = "somebody"
    return f"{user}@{socket.gethostname()}"


def _ids(stops: Sequence[Stop]) -> frozenset[int]:
    return frozenset(stop.id for stop in stops)


def _sayable(text: str) -> str:
    """Return what surely arrives: a stop must not fail for its words."""
    return text[:_LONGEST].encode("utf-8", "replace").decode()
