"""Who drives: among the sources that claim the robot, the one of the highest priority.

Within one source the sender that drives keeps it until it lets go or falls silent.
"""

from collections.abc import Iterable, Mapping
from typing import Annotated, Literal, NamedTuple, Protocol

from msgspec import Meta, Struct

from zteleop.control.deadlines import HEARD_LATE, SILENCE
from zteleop.control.proof import NEVER
from zteleop.messages import Pwm, Twist


class Source(Struct, frozen=True, forbid_unknown_fields=True):
    """A kind of sender and what it may do."""

    priority: Annotated[int, Meta(ge=0, le=255)]
    silence: Annotated[float, Meta(gt=0, le=1)] = SILENCE
    """s without a command until neutral"""
    trust: Literal["proof", "arrival"] = "proof"
    """arrival: obey foreign senders that cannot prove the age of what they say"""
    max_speed: Annotated[float, Meta(gt=0)] | None = None
    """m/s"""
    resume: bool = False
    """With trust = "arrival": drive on after the robot's start without a pause, as no other sender may."""


WAITING = 64
"""How many senders that wait are remembered."""


class Claim(NamedTuple):
    """A command that passed the gate."""

    source: str
    sender: int
    command: Twist | Pwm
    acted: float
    at: float
    seq: int
    beat: float
    """The newest of the robot's that its sender had heard."""
    began: float


class Silences:
    """When a claim is over: nothing more was heard of its sender, or by it, or nobody acts any more."""

    def __init__(self, sources: Mapping[str, Source], operator: float) -> None:
        self._of = {name: source.silence for name, source in sources.items()}
        self.operator = operator

    def of(self, source: str) -> float:
        """Return the s without a word of a source's sender, after which it no longer drives."""
        return self._of[source]

    def shorten(self, source: str, seconds: float) -> None:
        """Let it be less, between two steps."""
        self._of[source] = seconds

    def silent(self, claim: Claim, now: float) -> bool:
        """Say whether nothing more was heard of a claim's sender, or by its sender."""
        silence = self._of[claim.source]
        return not (now - claim.at <= silence and now - claim.beat <= silence + HEARD_LATE)

    def idle(self, claim: Claim, now: float) -> bool:
        """Say whether nobody acts any more."""
        return not now - claim.acted <= self.operator

    def over(self, claim: Claim, now: float) -> bool:
        """Say whether it is over for any of these reasons."""
        return self.silent(claim, now) or self.idle(claim, now)

    def end(self, claim: Claim) -> float:
        """Return the last moment at which it is not over, where nothing more is heard and nobody acts."""
        silence = self._of[claim.source]
        return min(claim.at + silence, claim.beat + silence + HEARD_LATE, claim.acted + self.operator)


class Claims(Protocol):
    """The claims that passed the gate, until they are let go."""

    @property
    def claims(self) -> Iterable[Claim]:
        """All of them, over or not."""

    def offer(self, claim: Claim) -> bool:
        """Take a claim; False when it must wait."""

    def release(self, sender: int) -> None:
        """Let go whatever a sender holds, or waits for."""

    def clear(self) -> None:
        """Let everybody go."""

    def select(self, now: float, after: float = NEVER) -> Claim | None:
        """Return the claim to obey, heard later than `after`; None when nobody may drive."""


class Mux:
    """Keeps the claim of each source until it is let go."""

    def __init__(self, sources: Mapping[str, Source], silences: Silences, link_loss: float) -> None:
        self._silences = silences
        self._link_loss = link_loss
        self._ranked = sorted(sources, key=lambda name: -sources[name].priority)
        self._claims: dict[str, Claim] = {}
        self._waiting: dict[tuple[str, int], float] = {}
        """When each sender was last told that another drives."""

    @property
    def claims(self) -> Iterable[Claim]:
        return self._claims.values()

    def offer(self, claim: Claim) -> bool:
        """Take a claim; False when another sender holds its source, or did since this one began.

        A holder that fell silent keeps the place for as long as it has the right to go on.
        """
        holder = self._claims.get(claim.source)
        if holder and holder.sender != claim.sender and claim.at - holder.at <= self._link_loss:
            self._waiting[claim.source, claim.sender] = claim.at
            if len(self._waiting) > WAITING:
                del self._waiting[next(iter(self._waiting))]
            return False
        if claim.began <= self._waiting.get((claim.source, claim.sender), NEVER):
            return False  # what was held down meanwhile must not drive by itself once it may
        self._waiting.pop((claim.source, claim.sender), None)
        self._claims[claim.source] = claim
        return True

    def release(self, sender: int) -> None:
        """Let go whatever a sender holds, or waits for."""
        self._waiting = {waits: at for waits, at in self._waiting.items() if waits[1] != sender}
        self._claims = {name: claim for name, claim in self._claims.items() if claim.sender != sender}

    def clear(self) -> None:
        self._claims.clear()

    def select(self, now: float, after: float = NEVER) -> Claim | None:
        """Return the claim to obey, heard later than `after`; None when nobody may drive."""
        for name in self._ranked:
            claim = self._claims.get(name)
            if claim and claim.at > after and not self._silences.over(claim, now):
                return claim
        return None
