"""May this command move the robot? Each is judged by its proof alone; silence never arms."""

from collections import OrderedDict
from enum import StrEnum
from typing import Annotated

from msgspec import Meta, Struct

from zteleop.control.proof import NEVER, Proof

SENDERS = 64
"""How many senders are remembered; whoever is forgotten must let go once more."""


class Deadlines(Struct, frozen=True, forbid_unknown_fields=True):
    """How long is too long, in seconds."""

    max_age: Annotated[float, Meta(gt=0, le=1)] = 0.3
    """of a command, from the robot's beat back to the robot"""
    operator: Annotated[float, Meta(gt=0, le=5)] = 5.0
    """without an act"""
    link_loss: Annotated[float, Meta(gt=0, le=5)] = 2.0
    """of silence, after which only a new act from neutral drives again"""
    late_step: Annotated[float, Meta(gt=0.05, le=1)] = 0.2
    """between two steps, after which the robot knows it was stopped itself"""


class Refusal(StrEnum):
    """Why a command does not count."""

    UNPROVEN = "it carries no proof; publish through a zteleop Node, or trust this source by arrival"
    EARLIER_START = "it was made before the robot's last start"
    REPLAYED = "it repeats an older command"
    STALE = "it is too old, or its sender no longer hears the robot"
    OPERATOR_IDLE = "its operator has not acted for too long"
    NOT_FROM_NEUTRAL = "it was moving before the robot started or the link came back; let go first, or pause"
    HELD = "another sender drives this source, or did since the last act"
    AT_REST = "the robot is kept at rest; let go, and begin anew when it is free"
    NO_SUCH_CHANNEL = "this vehicle has no steering and throttle; send a twist"


class Seen(Struct):
    """What the gate remembers of a sender."""

    seq: int
    beat: float
    at: float
    moving: bool
    floor: float


class Gate:
    """Knows the present epoch and the last live command of each sender.

    With a grace, in seconds, it is a second opinion: where it cannot know better it lets pass.
    """

    def __init__(self, deadlines: Deadlines, epoch: int, now: float, grace: float = 0.0) -> None:
        self._deadlines, self._grace = deadlines, grace
        self._senders: OrderedDict[int, Seen] = OrderedDict()
        self.restart(epoch, now)

    def restart(self, epoch: int, now: float) -> None:
        """Forget every sender; what began before now is over."""
        self.epoch, self._floor, self._forgotten = epoch, now - self._grace, NEVER
        self._senders.clear()

    def begin_after(self, now: float) -> None:
        """Count only claims that leave neutral later than now."""
        self._floor = max(self._floor, now - self._grace)

    def judge(self, proof: Proof | None, moving: bool, now: float) -> Refusal | None:
        """Return why a command is refused, or None when it counts."""
        if proof is None:
            return Refusal.UNPROVEN
        if proof.epoch != self.epoch:
            return Refusal.EARLIER_START
        seen = self._senders.get(proof.sender)
        if seen and not (proof.seq > seen.seq and proof.beat >= seen.beat):
            return Refusal.REPLAYED
        if not 0 <= now - proof.beat <= self._deadlines.max_age:
            return Refusal.STALE
        floor = self._remember(proof, seen, moving, now)
        if not moving:
            return None
        if not 0 <= now - proof.acted <= self._deadlines.operator:
            return Refusal.OPERATOR_IDLE
        return None if floor < proof.began <= proof.acted else Refusal.NOT_FROM_NEUTRAL

    def _remember(self, proof: Proof, seen: Seen | None, moving: bool, now: float) -> float:
        """Note a live command; return the time after which its claim must have begun."""
        floor = seen.floor if seen else self._forgotten
        heard = seen.at if seen and seen.moving else NEVER
        loss = self._deadlines.link_loss + self._grace
        if moving and now - max(heard, proof.began) > loss:  # it may have begun while nothing was heard
            floor = max(floor, now - loss)
        if now - heard > loss and not self._grace:
            floor = max(floor, heard + loss)
        self._senders[proof.sender] = Seen(proof.seq, proof.beat, now, moving, floor)
        self._senders.move_to_end(proof.sender)
        if len(self._senders) > SENDERS:
            self._forgotten = self._senders.popitem(last=False)[1].at - self._grace
        return max(floor, self._floor)
