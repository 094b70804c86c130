"""The straight line from commands to pulses: gate -> mux -> limiter -> mixer -> servo."""

from typing import NamedTuple

from zteleop.control.admission import Admission, Verdict
from zteleop.control.calibration import Calibration
from zteleop.control.cap import Bound
from zteleop.control.gate import Refusal
from zteleop.control.limiter import Limits
from zteleop.control.mixer import Wheels
from zteleop.control.movement import Movement
from zteleop.control.mux import Claim
from zteleop.control.proof import Proof, called
from zteleop.control.settings import DriveSettings
from zteleop.messages import Pwm, State, Twist


class Step(NamedTuple):
    """What one step decided, and why."""

    state: State
    why: str
    claim: Claim | None
    wheels: Wheels
    pulse_us: dict[int, float]
    bound: Bound


class Drive:
    """Takes commands in, gives pulses out: what may move is admission's, how is movement's."""

    def __init__(self, settings: DriveSettings, tick_us: float, epoch: int, now: float) -> None:
        self.settings = settings
        self.calibration = Calibration(settings.servos, tick_us)
        self.admission = Admission(settings, self.calibration, epoch, now)
        self.movement = Movement(settings, self.calibration)
        self.clamped = 0
        """commands so far that asked for more than a servo can do"""

    @property
    def limits(self) -> Limits:
        """The bounds of motion that hold; others may take their place between two steps."""
        return self.movement.limits

    @limits.setter
    def limits(self, limits: Limits) -> None:
        self.movement.limits = limits

    def receive(self, source: str, command: Twist | Pwm, proof: Proof | None, now: float) -> Refusal | None:
        """Judge a command that arrived; return why it does not count."""
        verdict = self.admission.receive(source, command, proof, now)
        if verdict.age is not None:
            self._measure(source, verdict, verdict.age, now)
        if verdict.refusal is None and isinstance(command, Pwm):
            self.clamped += bool(self.calibration.ends(command))
        return verdict.refusal

    def step(self, now: float) -> Step:
        """Decide the pulses of now."""
        claim = self.admission.select(now)
        wheels, bound = self.movement.obey(claim, now)
        if claim is None or wheels is None:
            rest, neutral_us = self.calibration.rest, self.calibration.neutral_us
            return Step(*self.admission.rest(now), None, rest, neutral_us, bound)
        pulse_us = self.calibration.pulse_us(wheels)
        who = called(claim.source, f"{claim.sender:x}")
        return Step("driving", f"{who} drives", claim, wheels, pulse_us, bound)

    def _measure(self, source: str, verdict: Verdict, age: float, now: float) -> None:
        """Note how old a command was; what cannot prove it counts as old as a command may be."""
        oldest = self.settings.deadlines.max_age
        if verdict.refusal is None:
            self.movement.cap.note(source, verdict.sender, min(age, oldest), now)
        elif verdict.refusal is Refusal.STALE and age > oldest:
            self.movement.cap.note_late(source, verdict.sender, oldest, now)
