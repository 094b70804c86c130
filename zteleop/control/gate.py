"""May this command move the robot? Each is judged by its proof alone; silence never arms."""

from collections import OrderedDict
from enum import StrEnum

from msgspec import Struct

from zteleop.control.deadlines import Deadlines
from zteleop.control.proof import NEVER, Proof

SENDERS = 64
"""How many senders are remembered; whoever is forgotten must let go once more. Never who drives."""

ANEW = "let go first, or start it anew"
"""what whoever moved before something ended does to begin once more"""


class Refusal(StrEnum):
    """Why a command does not count."""

    UNPROVEN = "it carries no proof; publish through a zteleop Node, or trust this source by arrival"
    EARLIER_START = "the command was made before the robot's last start"
    REPLAYED = "it repeats an older command"
    STALE = "the command is too old, or its sender no longer hears the robot"
    OPERATOR_IDLE = "its operator has not acted for too long"
    NOT_FROM_NEUTRAL = f"it was moving before the robot was ready; {ANEW}"
    LAPSED = f"it was moving before it was silent, or cut off, for too long; {ANEW}"
    BEFORE_RELEASE = f"it was moving before the stop was released; {ANEW}"
    BEFORE_REPAIR = f"it was moving before the chip's fault was over; {ANEW}"
    INTERRUPTED = "it was said before an interruption ended; act once more"
    HELD = "another sender drives this source; let go, and begin anew when that one is done"
    WAITED = "another sender drove this source when this one began, and is done; let go, and begin anew"
    AT_REST = "the robot is kept at rest; let go, and begin anew when it is free"
    NO_SUCH_CHANNEL = "this vehicle has no steering and throttle; send a twist"


BEGUN_BEFORE = (
    Refusal.EARLIER_START,
    Refusal.NOT_FROM_NEUTRAL,
    Refusal.LAPSED,
    Refusal.BEFORE_RELEASE,
    Refusal.BEFORE_REPAIR,
)
"""Whoever is refused so talks on, and lacks more than an act."""


class Seen(Struct):
    """What the gate remembers of a sender."""

    seq: int
    beat: float
    at: float
    moving: bool
    floor: float
    """A claim must have begun later, unless it has the right to go on."""
    claim: float = NEVER
    """When the claim that counted last began."""
    counted: float = NEVER
    """When it did."""
    right: float = NEVER
    """When the claim began that may go on after an interruption."""
    resumed: float = NEVER
    """When this sender was heard again; what it said, or did, before that counts for nothing."""


class Gate:
    """Knows the present epoch and the last live command of each sender.

    An interruption is whatever keeps the robot from obeying for a while: a lost link, a robot that is
    deaf or stood still. It has one measure, the time since a command of a claim last counted. A claim
    that was interrupted for no longer than `link_loss` has the right to go on, with what is said and
    done after the end of it; any other must begin anew.

    With a grace, in seconds, it is a second opinion: where it cannot know better it lets pass.
    """

    def __init__(self, deadlines: Deadlines, epoch: int, now: float, grace: float = 0.0) -> None:
        self._deadlines = deadlines
        self.operator_silence = deadlines.operator
        """s without an act, after which nothing counts"""
        self._grace = grace
        self._senders: OrderedDict[int, Seen] = OrderedDict()
        self.restart(epoch, now)

    def restart(self, epoch: int, now: float) -> None:
        """Forget every sender; what began before now is over."""
        self.epoch, self._floor, self._forgotten = epoch, now - self._grace, NEVER
        self._resumed = NEVER
        self._over = Refusal.NOT_FROM_NEUTRAL
        self._senders.clear()

    @property
    def floor(self) -> float:
        """Claims that began up to then are over, whoever has a right."""
        return self._floor

    def take_over(self, floor: float) -> None:
        """Count from where another gate of this epoch did; `recall`, and then `interrupt`, must follow."""
        self._floor = floor

    def recall(self, sender: int, began: float, at: float) -> None:
        """Know a claim again that another gate of this epoch last counted at that time."""
        self._senders[sender] = Seen(0, NEVER, at, True, NEVER, began, at)

    def last_counted(self, sender: int) -> float:
        """Return when a command of a sender last counted."""
        seen = self._senders.get(sender)
        return seen.counted if seen else NEVER

    def begin_after(self, now: float, why: Refusal = Refusal.NOT_FROM_NEUTRAL) -> None:
        """Count only claims that leave neutral later than now, and refuse all others by that word."""
        self._floor, self._over = max(self._floor, now - self._grace), why

    def interrupt(self, now: float, limit: float) -> None:
        """End an interruption; claims that counted within `limit` seconds may go on, others begin anew."""
        self._resumed = now - self._grace
        if self._grace:
            return  # who goes on is the first opinion's affair; that nothing old moves it, is both's
        self._forgotten = max(self._forgotten, self._resumed)
        for seen in self._senders.values():
            goes_on = seen.moving and now - seen.counted <= limit
            seen.right = seen.claim if goes_on else NEVER
            seen.floor = max(seen.floor, self._resumed)

    def count(self, proof: Proof, now: float) -> None:
        """Note that a command counted."""
        if seen := self._senders.get(proof.sender):
            seen.claim, seen.counted = proof.began, now

    def hear(self, proof: Proof, now: float) -> None:
        """Note a command of a claim that counted, and lacks nothing but an act: its link is whole."""
        if (seen := self._senders.get(proof.sender)) and seen.claim == proof.began:
            seen.counted = now

    def judge(
        self, proof: Proof | None, moving: bool, now: float, silence: float = float("inf")
    ) -> Refusal | None:
        """Return why a command is refused, or None when it counts; `silence` is its source's, in seconds."""
        if proof is None:
            return Refusal.UNPROVEN
        if proof.epoch != self.epoch:
            return Refusal.EARLIER_START
        seen = self._senders.get(proof.sender)
        if seen and not (proof.seq > seen.seq and proof.beat >= seen.beat):
            return Refusal.REPLAYED
        if not 0 <= now - proof.beat <= self._deadlines.max_age:
            return Refusal.STALE
        seen = self._remember(proof, seen, moving, now, silence)
        if not moving:
            return None
        if not self._may_begin(proof, seen):  # first: a claim that is over lacks more than an act
            return self._over if proof.began <= self._floor else Refusal.LAPSED
        if not 0 <= now - proof.acted <= self.operator_silence:
            return Refusal.OPERATOR_IDLE
        resumed = max(self._resumed, seen.resumed)
        return None if proof.beat > resumed and proof.acted > resumed else Refusal.INTERRUPTED

    def _may_begin(self, proof: Proof, seen: Seen) -> bool:
        """Say whether a claim began late enough, or goes on by right; no right outlives a release."""
        goes_on = proof.began == seen.right
        return self._floor < proof.began <= proof.acted and (goes_on or proof.began > seen.floor)

    def _remember(self, proof: Proof, seen: Seen | None, moving: bool, now: float, silence: float) -> Seen:
        """Note a live command, and what it may do after it was not heard for a while."""
        before = seen or Seen(0, NEVER, NEVER, False, self._forgotten)
        after = Seen(proof.seq, proof.beat, now, moving, before.floor, before.claim, before.counted)
        if moving:  # letting go ends what a claim may
            after.right, after.resumed = before.right, before.resumed
        self._measure_loss(before, after, proof, silence)
        self._senders[proof.sender] = after
        self._senders.move_to_end(proof.sender)
        if len(self._senders) > SENDERS:
            self._forget_one(now)
        return after

    def _forget_one(self, now: float) -> None:
        """Forget who spoke longest ago, and has no right to go on: whoever drives is remembered."""
        others = (s for s, seen in self._senders.items() if now - seen.counted > self._deadlines.link_loss)
        gone = self._senders.pop(next(others, next(iter(self._senders))))
        self._forgotten = max(self._forgotten, gone.at - self._grace)

    def _measure_loss(self, before: Seen, after: Seen, proof: Proof, silence: float) -> None:
        """Take the right from what was not heard, or did not count, for too long."""
        now, loss = after.at, self._deadlines.link_loss + self._grace
        heard = before.at if before.moving else NEVER
        if after.moving and now - max(heard, proof.began) > loss:  # it may have begun while nothing was heard
            after.floor = max(after.floor, now - loss)
        if self._grace:
            return
        counted = before.counted if before.moving and before.counted > NEVER else heard
        for last in (heard, counted):
            if now - last > loss:  # what begins within the age of any command begins now, loss or no loss
                begins = min(last + loss, now - self._deadlines.max_age)
                after.floor, after.right = max(after.floor, begins), NEVER
        if after.moving and proof.began <= heard < now - silence:  # the same claim, heard again
            after.resumed = now
