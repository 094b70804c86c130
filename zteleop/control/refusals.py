"""Who is refused, and why; a sender for long enough is told: a program that streams hears it no other way."""

from typing import NamedTuple

from zteleop.control.gate import Refusal
from zteleop.control.proof import LAPSE

TOLD_AFTER = 0.5
"""s of refusals without one command that counted; a single late command is nobody's news"""
FORGOTTEN_AFTER = LAPSE
"""s without a command"""
NAMED = 8
"""of those who were refused last, each of whom is worth a sentence"""
SENDERS = 64
"""How many are remembered; whoever comes then waits until one is obeyed or silent."""


class Refused(NamedTuple):
    """What the gate last said to a sender."""

    sender: int
    why: Refusal
    since: float
    at: float
    times: int


Sender = tuple[str, int]
"""a source, and one that speaks as it; 0 where it did not say who it is"""


class LastRefusals:
    """Keeps what was last said to each sender, for whoever asks why the robot rests."""

    def __init__(self) -> None:
        self.count = 0
        """of all refusals so far"""
        self._senders: dict[Sender, Refused] = {}

    def note(self, source: str, sender: int, why: Refusal, now: float) -> None:
        """Remember a refusal; those in a row for one reason are one."""
        self.count += 1
        last = self._senders.pop((source, sender), None)
        since, times = (last.since, last.times) if last and last.why == why else (now, 0)
        self._senders[source, sender] = Refused(sender, why, since, now, times + 1)
        if len(self._senders) > NAMED:
            del self._senders[next(iter(self._senders))]

    def clear(self, source: str, sender: int) -> None:
        """Forget what was said to a sender that counts again, or lets go."""
        self._senders.pop((source, sender), None)

    def forget(self, why: Refusal) -> None:
        """Forget who was refused for a reason that is over."""
        self._senders = {sender: last for sender, last in self._senders.items() if last.why != why}

    def silence(self, source: str, sender: int, counted: float, now: float) -> float:
        """Return for how long a sender has said nothing, whose last word that counted came at a time."""
        last = self._senders.get((source, sender))
        return now - max(counted, last.at if last else counted)

    def recent(self, now: float, seconds: float) -> dict[Sender, Refused]:
        """Return what was said in the last seconds, who was last refused at the end."""
        return {sender: last for sender, last in self._senders.items() if now - last.at < seconds}


class Turned(NamedTuple):
    """A sender that is refused, or waits, why, since when, and when it was last."""

    source: str
    why: str
    since: float
    at: float


class RefusedSenders:
    """Keeps each sender from its first refused command to the next that counts."""

    def __init__(self) -> None:
        self._senders: dict[int, Turned] = {}
        self._told: set[int] = set()

    def note(self, sender: int, source: str, refusal: str | None, now: float) -> None:
        """Remember how a command was judged; None is one that counts."""
        if refusal is None:
            if self._senders:
                self._senders.pop(sender, None)
            return
        last = self._senders.get(sender)
        if last and now - last.at <= FORGOTTEN_AFTER:
            self._senders[sender] = Turned(source, refusal, last.since, now)
        elif last or len(self._senders) < SENDERS:
            self._senders[sender] = Turned(source, refusal, now, now)
        else:
            self._forget(now)

    def news(self, now: float) -> dict[int, Turned] | None:
        """Return who must be told now; None when there is nothing to say.

        Nobody is said once: to those who were told, and count again.
        """
        if not self._senders and not self._told:
            return None
        self._forget(now)
        found = {sender: last for sender, last in self._senders.items() if now - last.since > TOLD_AFTER}
        told, self._told = self._told, set(found)
        return found if found or told else None

    def _forget(self, now: float) -> None:
        silent = [sender for sender, last in self._senders.items() if now - last.at > FORGOTTEN_AFTER]
        for sender in silent:
            del self._senders[sender]
            self._told.discard(sender)  # whoever says nothing is not obeyed again either
