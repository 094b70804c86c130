"""Proof that a command is new, in times of the robot's own clock.

No two clocks agree, and a network delivers late what it queued. So the sender echoes
the robot's beats: whatever carries a beat was made after the robot sent it.
"""

from typing import NamedTuple

from zteleop.control.deadlines import LINK_LOSS, PROGRAM_SILENCE
from zteleop.messages import Beat

NEVER = float("-inf")
LAPSE = LINK_LOSS
"""s of silence after which nobody takes what is said next for the rest of a claim that is over."""


class Proof(NamedTuple):
    """What every command carries; the three times are the robot's, in seconds."""

    sender: int
    """random per publisher"""
    seq: int
    epoch: int
    """the start of the robot that the times belong to"""
    beat: float
    """the newest beat heard"""
    acted: float
    """the newest heard when the operator last acted"""
    began: float
    """the newest heard when this claim left neutral"""


def called(source: str, sender: str) -> str:
    """Return what people call one sender of a source everywhere; `sender` is in hexadecimal digits.

    One that cannot prove who it is has none that counts, and is called by its source.
    """
    nameless = not sender.strip("0") or sender.startswith("-")
    return source if nameless else f"{source} {sender[-4:].zfill(4)}"


class Prover:
    """Makes the proofs of one sender."""

    def __init__(self, sender: int, silence: float = PROGRAM_SILENCE, lapse: float = LAPSE) -> None:
        self._sender = sender
        self._silence = silence
        self._lapse = max(silence, lapse)
        self._seq = 0
        self._epoch = -1
        self._acted = NEVER
        self._began = NEVER
        self._moving = False
        self._then = NEVER

    @property
    def sender(self) -> int:
        return self._sender

    @property
    def moving(self) -> bool:
        """Whether the last command asked for anything but rest."""
        return self._moving

    def act(self, beat: Beat | None) -> None:
        """Note that the operator acted, having heard `beat`."""
        if beat:
            self._hear(beat)
            self._acted = beat.time

    def prove(self, beat: Beat | None, moving: bool, now: float, awake_since: float = NEVER) -> Proof | None:
        """Return the proof of a command sent now, by the sender's clock; None before the first beat.

        A claim that was moving before the robot started, or before a release, never has a beginning:
        it must be let go, or fall silent for `LAPSE`, first. However slow its messages are, a stream
        does not begin anew by itself. Nor does one whose process stood still: it has paused since it woke.
        """
        if beat:
            self._hear(beat)
        self._then = max(self._then, awake_since)
        if moving and (not self._moving or self._has_paused(beat, now)):
            self._began = self._acted
        self._moving, self._then = moving, now
        if beat is None:
            return None
        self._seq += 1
        return Proof(self._sender, self._seq, beat.epoch, beat.time, self._acted, self._began)

    def hold_on(self, beat: Beat, now: float) -> None:
        """Note that what moves goes on moving, although nothing is proved: it has not paused."""
        if not self._has_paused(beat, now):
            self._then = now

    def let_go(self) -> None:
        """End the claim: what moves next begins anew."""
        self._moving = False

    def _has_paused(self, beat: Beat | None, now: float) -> bool:
        """Say whether what moves now is another claim than what moved before."""
        is_over = beat is None or self._began <= beat.floor
        return now - self._then > (self._lapse if is_over else self._silence)

    def _hear(self, beat: Beat) -> None:
        if beat.epoch != self._epoch:
            self._epoch = beat.epoch
            self._acted = self._began = NEVER
