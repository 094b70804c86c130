"""Senders that cannot prove the age of what they say: each command is taken for an act of its arrival."""

from collections.abc import Mapping

from zteleop.control.deadlines import PROGRAM_SILENCE
from zteleop.control.mux import Claim, Source
from zteleop.control.proof import LAPSE, Proof, Prover
from zteleop.messages import Beat

FOREIGN_SILENCE = PROGRAM_SILENCE
"""s after which a foreign sender that moved begins anew, unless its claim is over."""


class Foreigners:
    """Makes the proofs of foreign senders, one for each source that is trusted by arrival."""

    def __init__(self, sources: Mapping[str, Source], grace: float, since: float) -> None:
        self._sources = sources
        self._pauses = FOREIGN_SILENCE - grace, 0.0 if grace else LAPSE
        self._since = since
        """when the robot started; what they did before, nobody knows"""
        self._provers: dict[str, Prover] = {}

    def trusted(self, source: str) -> bool:
        """Say whether a source is trusted by arrival alone."""
        return self._sources[source].trust == "arrival"

    def includes(self, claim: Claim) -> bool:
        """Say whether a claim is trusted by its arrival alone."""
        prover = self._provers.get(claim.source)
        return prover is not None and prover.sender == claim.sender

    def vouch(self, source: str, moving: bool, beat: Beat, now: float) -> Proof | None:
        """Make the proof of a command that arrives now."""
        prover = self._provers.get(source) or self._meet(source)
        prover.act(beat)
        return prover.prove(beat, moving, now)

    def hold_on(self, source: str, beat: Beat, now: float) -> None:
        """Take in a command that does not count, so that the claim it belongs to is not over."""
        (self._provers.get(source) or self._meet(source)).hold_on(beat, now)

    def recall(self, source: str, began: Beat, now: float) -> int:
        """Go on with a sender that drove under another drive, and return what it is called now."""
        prover = self._provers[source] = Prover(-1, *self._pauses)
        prover.act(began)
        prover.prove(began, True, now)
        return prover.sender

    def restart(self, now: float) -> None:
        """Forget them all."""
        self._provers.clear()
        self._since = now

    def _meet(self, source: str) -> Prover:
        prover = self._provers[source] = Prover(-len(self._provers) - 1, *self._pauses)
        if not self._sources[source].resume:
            prover.prove(None, True, self._since)
        return prover
