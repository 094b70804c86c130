"""A second opinion on what the actuator does, from the same commands and by the same gate, a little later."""

from collections.abc import Iterable, Mapping

from msgspec.structs import replace

from zteleop.control.admission import Admission
from zteleop.control.calibration import Calibration
from zteleop.control.deadlines import GRACE
from zteleop.control.gate import SENDERS, Refusal
from zteleop.control.mux import Claim, Silences
from zteleop.control.proof import NEVER, Proof
from zteleop.control.settings import DriveSettings
from zteleop.control.standing import Standing
from zteleop.messages import Pwm, Twist

LOOKS = 2
"""How many looks in a row must find the same fault: one may fall between a command and its pulse."""


class EveryClaim:
    """Keeps every claim until its silence: who drives, and who lets go, is the actuator's question.

    It may have lost the message by which somebody let go, and then its own deadline is what counts.
    """

    def __init__(self, silences: Silences) -> None:
        self._silences = silences
        self._claims: dict[tuple[str, int], Claim] = {}

    @property
    def claims(self) -> Iterable[Claim]:
        return self._claims.values()

    def offer(self, claim: Claim) -> bool:
        """Take every claim."""
        self._claims.pop((claim.source, claim.sender), None)  # the newest last: a driver is not forgotten
        self._claims[claim.source, claim.sender] = claim
        if len(self._claims) > SENDERS:
            del self._claims[next(iter(self._claims))]
        return True

    def release(self, sender: int) -> None:
        """Let nobody go before his silence."""

    def clear(self) -> None:
        self._claims.clear()

    def end(self, floor: float) -> None:
        """Forget what began no later than that."""
        self._claims = {key: claim for key, claim in self._claims.items() if claim.began > floor}

    def select(self, now: float, after: float = NEVER) -> Claim | None:
        """Return any claim that may move the robot, heard later than `after`; None when nobody may."""
        return next(
            (c for c in self._claims.values() if c.at > after and not self._silences.over(c, now)), None
        )


class Judge:
    """Knows which commands may move the robot now, and whether the chip's pulses are those of rest."""

    def __init__(self, settings: DriveSettings, tick_us: float, now: float) -> None:
        later = _later(settings)
        self._calibration = Calibration(settings.servos, tick_us)
        self._claims: EveryClaim  # which admission asks for
        self._admission = Admission(later, self._calibration, -1, now, self._keep, GRACE)
        self.neutral_us = self._calibration.neutral_us
        self._epoch = -1
        self._stopped: float | None = None
        self._last_stopped = now
        self._bad_looks = 0
        self._interrupted = NEVER
        self.released = NEVER
        self.moving = False

    def hear_report(self, standing: Standing) -> None:
        """Learn of the actuator's epoch, and of the last interruption; what was said before is too old."""
        if standing.epoch != self._epoch:
            self._epoch, self._interrupted = standing.epoch, standing.since
            self._admission.restart(standing.epoch, standing.since)
        if standing.interrupted > self._interrupted:
            self._interrupted = standing.interrupted
            self._admission.gate.interrupt(standing.interrupted, NEVER)

    def hear_release(self, now: float) -> None:
        """Learn that somebody released a stop: no claim from before may go on."""
        self.released = now

    def correct(self, standing: Standing) -> Standing:
        """Return where an actuator stood, with what it may not have heard: the release of a stop.

        Who drove goes on by what both have counted: what the watchdog slept through, this has not, and
        would stop whoever goes on by it.
        """
        counted = min(standing.counted, self._admission.gate.last_counted(standing.sender))
        floor = max(standing.floor, self.released)
        return standing._replace(floor=floor, counted=max(counted, 0.0))  # JSON has no infinity

    def receive(self, source: str, command: Twist | Pwm, proof: Proof | None, now: float) -> Refusal | None:
        """Judge a command that the watchdog heard itself."""
        refusal = self._admission.receive(source, command, proof, now).refusal
        if refusal is None and self.allowed(now):  # what moved before this was heard may have moved for it
            self._bad_looks = 0
        return refusal

    def rest(self, stopped: bool, now: float) -> None:
        """Learn whether a stop is in force; after its release only what begins anew counts.

        Commands are judged all the while: the first after a release may be heard before it.
        """
        if stopped:
            self._stopped, self._last_stopped = self._stopped or now, now
        elif self._stopped is not None:
            self._stopped = None
            self.hear_release(now)
            self._admission.gate.begin_after(self._last_stopped)  # it may have been released since
            self._claims.end(self._admission.gate.floor)
        if self._must_rest(now):
            self._admission.mux.clear()

    @property
    def stopped(self) -> bool:
        """Say whether a stop is in force, even if the actuator still has time to obey it."""
        return self._stopped is not None

    def allowed(self, now: float) -> bool:
        """Say whether somebody may drive now."""
        return not self._must_rest(now) and self._admission.select(now) is not None

    def at_rest(self, pulse_us: Mapping[int, float | None]) -> bool:
        """Say whether these pulses are neutral, to half a tick, or none at all."""
        return self._calibration.at_rest(pulse_us)

    def look(self, pulse_us: Mapping[int, float | None], now: float) -> str | None:
        """Compare the chip with what may be; return why a stop must be engaged, if it must."""
        self.moving = not self.at_rest(pulse_us)
        bad = self.moving and not self.allowed(now)
        self._bad_looks = self._bad_looks + 1 if bad else 0
        if self._bad_looks < LOOKS:
            return None
        why = "a stop is in force" if self._must_rest(now) else self._admission.rest(now)[1]
        return f"its pulses moved although {why.partition('; the next ')[0]}"

    def _keep(self, silences: Silences) -> EveryClaim:
        self._claims = EveryClaim(silences)
        return self._claims

    def _must_rest(self, now: float) -> bool:
        return self._stopped is not None and now - self._stopped > GRACE


def _later(settings: DriveSettings) -> DriveSettings:
    """Return the settings with every deadline later by the grace."""
    deadlines = replace(
        settings.deadlines,
        max_age=settings.deadlines.max_age + GRACE,
        operator=settings.deadlines.operator + GRACE,
    )
    sources = {
        name: replace(source, silence=source.silence + GRACE)
        for name, source in settings.known_sources.items()
    }
    return replace(settings, deadlines=deadlines, sources=sources)
