"""The straight line from commands to pulses: gate -> mux -> limiter -> mixer -> servo."""

from collections.abc import Iterable
from typing import NamedTuple

from msgspec import Struct, field

from zteleop.control.calibration import Calibration
from zteleop.control.cap import Bound, Cap, CapSettings
from zteleop.control.gate import Deadlines, Gate, Refusal
from zteleop.control.hold import PAUSE, Holds
from zteleop.control.limiter import Limits, TwistLimiter, WheelLimiter
from zteleop.control.mixer import Ackermann, Mixer, Wheels
from zteleop.control.mux import HEARD_LATE, Claim, Mux, Source
from zteleop.control.proof import LAPSE, NEVER, Proof, Prover
from zteleop.control.servo import Servo
from zteleop.control.stop import Latch, stopped_by
from zteleop.messages import Beat, Pwm, State, Stop, Twist

DONKEYCAR = {
    "throttle": Servo(channel=0, min_us=897.6, neutral_us=1509.6, max_us=2040.0),
    "steering": Servo(channel=1, min_us=1183.2, neutral_us=1530.0, max_us=1876.8),
}
"""220, 370, 500 and 290, 375, 460 ticks at 60 Hz, as Donkeycar ships them."""

SOURCES = {
    "web": Source(priority=100),
    "gamepad": Source(priority=95),
    "keyboard": Source(priority=90),
    "buttons": Source(priority=80),
    "program": Source(priority=50, silence=0.5),
}

FOREIGN_SILENCE = 0.5
"""s after which a foreign sender that moved begins anew, unless its claim is over."""


class DriveSettings(Struct, frozen=True, forbid_unknown_fields=True):
    """The vehicle, who may drive it, and its bounds."""

    mixer: Mixer = Ackermann()
    servos: dict[str, Servo] = field(default_factory=DONKEYCAR.copy)
    sources: dict[str, Source] = {}
    """besides, or instead of, those every robot knows"""
    limits: Limits = Limits()
    cap: CapSettings = CapSettings()
    deadlines: Deadlines = Deadlines()

    @property
    def known_sources(self) -> dict[str, Source]:
        return SOURCES | self.sources

    def __post_init__(self) -> None:
        if set(self.servos) != self.mixer.wheels:
            raise ValueError(f"servos must be {_names(self.mixer.wheels)}, found {_names(self.servos)}")
        channels = [servo.channel for servo in self.servos.values()]
        if len(set(channels)) < len(channels):
            raise ValueError(f"each servo needs a channel of its own, found {channels}")
        for name, source in self.sources.items():
            if source.resume and source.trust != "arrival":
                raise ValueError(f'resume is for trust = "arrival", found it at sources.{name}')


LACKS_AN_ACT = (Refusal.OPERATOR_IDLE, Refusal.INTERRUPTED)
BEFORE: dict[State, Refusal] = {"fault": Refusal.BEFORE_REPAIR}
"""Why whatever began before the end of a hold does not count, where it is not the start."""


class Refused(NamedTuple):
    """What the gate last said to a source."""

    why: Refusal
    since: float
    at: float
    times: int


class Step(NamedTuple):
    """What one step decided, and why."""

    state: State
    why: str
    claim: Claim | None
    wheels: Wheels
    pulse_us: dict[int, float]
    bound: Bound


class Drive:
    """Takes commands in, gives pulses out; owns no clock and no chip."""

    def __init__(
        self,
        settings: DriveSettings,
        tick_us: float,
        epoch: int,
        now: float,
        mux: Mux | None = None,
        grace: float = 0.0,
    ) -> None:
        self.settings = settings
        self.gate = Gate(settings.deadlines, epoch, now, grace)
        self._sources = settings.known_sources
        self.mux = mux or Mux(self._sources, settings.deadlines.operator, settings.deadlines.link_loss)
        self.cap = Cap(settings.cap, settings.limits.speed_of(settings.mixer), self._sources)
        self.refused = self.clamped = 0
        self.refusals: dict[str, Refused] = {}
        self.latch = Latch()
        self.holds = Holds()
        self.interruption = ""
        """What the last one was, in words."""
        self._gone: tuple[str, float] | None = None
        self._drove: int | None = None
        self._limiter = TwistLimiter(settings.limits, settings.mixer)
        self._wheel_limiter = WheelLimiter(settings.limits, settings.mixer, settings.servos)
        self.calibration = Calibration(settings.servos, tick_us)
        self._foreign: dict[str, Prover] = {}
        self._foreign_pauses = FOREIGN_SILENCE - grace, 0.0 if grace else LAPSE
        self._since = self._stepped = now

    def late(self, now: float) -> float:
        """Return for how long the robot itself stood still since the last step, in seconds; else 0."""
        gap = now - self._stepped
        return gap if gap > self.settings.deadlines.late_step else 0.0

    def interrupt(self, why: str, now: float, limit: float) -> None:
        """End an interruption: whoever counted in the last `limit` s goes on with the next act.

        What was said before counts for nothing, and whoever was not interrupted must begin anew.
        """
        self.gate.interrupt(now, limit)
        self.mux.interrupt(now)
        self.interruption, self._stepped = why, now

    @property
    def driver(self) -> Claim | None:
        """The claim that drove last, unless it was let go or has lost its place."""
        return next((claim for claim in self.mux.claims if claim.sender == self._drove), None)

    def beat(self, now: float) -> Beat:
        """Return what commands must echo from now on."""
        return Beat(self.gate.epoch, now, self.gate.floor)

    def recall(self, source: str, sender: int, began: float, counted: float, now: float) -> None:
        """Keep the place of a claim that drove under another drive of this epoch; `interrupt` must follow."""
        if sender < 0:
            prover = self._foreign[source] = Prover(-1, *self._foreign_pauses)
            prover.act(self.beat(began))
            prover.prove(self.beat(began), True, now)
            sender = prover.sender
        self.gate.recall(sender, began, counted)
        self.mux.offer(Claim(source, sender, Twist.zero(), counted, counted, 0, counted, began))
        self._drove = sender

    def restart(self, epoch: int, now: float) -> None:
        """Forget every claim and begin a new epoch."""
        self.gate.restart(epoch, now)
        self.mux.clear()
        self._foreign.clear()
        self._gone = None
        self._since = self._stepped = now

    def hold(self, reason: str, state: State, why: str, now: float) -> None:
        """Keep the robot at rest for a reason until `free`; nothing softens it."""
        self.holds.add(reason, state, why, now)
        self.mux.clear()

    def pause(self, reason: str, why: str, now: float) -> None:
        """Keep the robot at rest until `resume`, by an interruption that lets claims keep their place."""
        if reason not in self.holds:  # a stricter one stays what it is
            self.holds.add(reason, PAUSE, why, now)

    def resume(self, reason: str, why: str, now: float) -> None:
        """End an interruption that began with `pause`, or with `hold` where nobody can have a right yet."""
        if self.holds.drop(reason):
            self.interrupt(why, now, self.settings.deadlines.link_loss)

    def free(self, reason: str, now: float) -> None:
        """Drop a reason to rest; whoever drives next must leave neutral after now."""
        if hold := self.holds.drop(reason):
            self.gate.begin_after(now, BEFORE.get(hold.state, Refusal.NOT_FROM_NEUTRAL))

    def stop(self, said: Stop, now: float) -> bool:
        """Obey a stop or a release of one; True when that changed anything."""
        changed = self.latch.obey(said)
        if changed and self.latch.stops:
            self.hold("stop", "stopped", stopped_by(self.latch.stops), now)
        elif changed:  # a release, perhaps of a stop that never arrived
            self.holds.drop("stop")
            self.mux.clear()
            self.gate.begin_after(now, Refusal.BEFORE_RELEASE)
        return changed

    def withdraw(self, sender: int, now: float) -> None:
        """Let go what a sender held whose process is gone."""
        for claim in self.mux.claims:
            if claim.sender == sender:
                self._gone = (claim.source, now)
        self.mux.release(sender)

    def receive(self, source: str, command: Twist | Pwm, proof: Proof | None, now: float) -> Refusal | None:
        """Judge a command that arrived; return why it does not count."""
        if isinstance(command, Pwm) and not isinstance(self.settings.mixer, Ackermann):
            return self._refuse(source, Refusal.NO_SUCH_CHANNEL, now)
        moving = self._moves(command)
        unproven = proof is None and self._sources[source].trust == "arrival"
        if unproven and moving and now - self.mux.interrupted <= self.settings.deadlines.max_age:
            # Nobody can prove that it was not said before the interruption ended, and queued meanwhile.
            (self._foreign.get(source) or self._meet(source)).hold_on(self.beat(now), now)
            return self._refuse(source, Refusal.INTERRUPTED, now)
        if unproven:
            proof = self._vouch(source, moving, now)
        refusal = self._judge(source, command, proof, moving, now)
        if proof and moving:
            self._measure(source, proof, NEVER if unproven else proof.beat, refusal, now)
        if refusal:
            return self._refuse(source, refusal, now)
        if isinstance(command, Pwm):
            self.clamped += self.calibration.exceeds(command)
        return None

    def is_foreign(self, claim: Claim) -> bool:
        """Say whether a claim is trusted by its arrival alone."""
        prover = self._foreign.get(claim.source)
        return prover is not None and prover.sender == claim.sender

    def step(self, now: float) -> Step:
        """Decide the pulses of now."""
        self._stepped = now
        claim = self.mux.select(now) if not self.holds else None
        self._drove = claim.sender if claim else self._drove
        bound = self.cap.find(claim.source, now) if claim else self.cap.rest()
        wheels = self._wheel_limiter.limit(self._obey(claim, bound.speed, now), now)
        if claim is None or wheels is None:
            rest, neutral_us = self.calibration.rest, self.calibration.neutral_us
            return Step(*self._explain_rest(now), None, rest, neutral_us, bound)
        pulse_us = self.calibration.pulse_us(wheels)
        return Step("driving", f"{claim.source} drives", claim, wheels, pulse_us, bound)

    def _refuse(self, source: str, refusal: Refusal, now: float) -> Refusal:
        self.refused += 1
        last = self.refusals.get(source)
        since, times = (last.since, last.times) if last and last.why == refusal else (now, 0)
        self.refusals[source] = Refused(refusal, since, now, times + 1)
        return refusal

    def _explain_rest(self, now: float) -> tuple[State, str]:
        state, why = self._find_rest(now)
        recent = {source: refused for source, refused in self.refusals.items() if now - refused.at < 1.0}
        if recent and not self.holds:
            source = max(recent, key=lambda name: recent[name].at)
            why += f"; {source} is refused: {recent[source].why}"
        return state, why

    def _find_rest(self, now: float) -> tuple[State, str]:
        if held := self.holds.strongest:
            return held.state, held.why
        newest = max(self.mux.claims, key=lambda claim: claim.at, default=None)
        if newest and newest.at <= (end := self.mux.interrupted) and not self.mux.idle(newest, end):
            return "link lost", f"{self.interruption}; {newest.source} goes on with its next act"
        if newest is None:
            return ("link lost", f"{self._gone[0]} is gone") if self._gone else ("idle", "nobody drives")
        silence = self._sources[newest.source].silence
        fell_silent, unheard = newest.at + silence, newest.beat + silence + HEARD_LATE
        if self.mux.idle(newest, min(now, fell_silent, unheard)):  # which deadline was the first to pass
            return "operator idle", f"no act on {newest.source} for {now - newest.acted:.1f} s"
        if now < fell_silent:
            return "link lost", f"{newest.source} has not heard the robot for {now - newest.beat:.1f} s"
        return "link lost", f"{newest.source} has been silent for {now - newest.at:.1f} s"

    def _judge(
        self, source: str, command: Twist | Pwm, proof: Proof | None, moving: bool, now: float
    ) -> Refusal | None:
        refusal = self.gate.judge(proof, moving, now, self._sources[source].silence)
        if refusal or proof is None:
            if proof and refusal in LACKS_AN_ACT and not self.holds:
                self.gate.hear(proof, now)
            return refusal
        if not moving:
            self._gone = None  # a last neutral may arrive after the news of its sender's end
            self.mux.release(proof.sender)
            return None
        if self.holds:
            return Refusal.INTERRUPTED if self.holds.pass_by_themselves else Refusal.AT_REST
        self._gone = None
        claim = Claim(source, proof.sender, command, proof.acted, now, proof.seq, proof.beat, proof.began)
        if not self.mux.offer(claim):
            return Refusal.HELD
        self.gate.count(proof, now)
        return None

    def _measure(self, source: str, proof: Proof, beat: float, refusal: Refusal | None, now: float) -> None:
        """Note how old a command was; what cannot prove it counts as old as a command may be."""
        age, oldest = now - beat, self.settings.deadlines.max_age
        if refusal is None:
            self.cap.note(source, proof.sender, min(age, oldest), now)
        elif refusal is Refusal.STALE and age > oldest:
            self.cap.note_late(source, proof.sender, oldest, now)

    def _vouch(self, source: str, moving: bool, now: float) -> Proof | None:
        """Make the proof of a foreign sender from its arrival: each command is an act of now."""
        prover = self._foreign.get(source) or self._meet(source)
        beat = self.beat(now)
        prover.act(beat)
        return prover.prove(beat, moving, now)

    def _meet(self, source: str) -> Prover:
        """Make a foreign sender's prover; what it did before the start, nobody knows."""
        prover = self._foreign[source] = Prover(-len(self._foreign) - 1, *self._foreign_pauses)
        if not self._sources[source].resume:
            prover.prove(None, True, self._since)
        return prover

    def _moves(self, command: Twist | Pwm) -> bool:
        if isinstance(command, Pwm):
            return not self.calibration.neutral(command)
        return command.linear.x != 0 or command.angular.z != 0

    def _obey(self, claim: Claim | None, max_speed: float, now: float) -> Wheels | None:
        if claim is None:
            self._limiter.limit(None, now)
            return None
        if isinstance(claim.command, Twist):
            twist = self._limiter.limit(claim.command, now, max_speed)
            return self.settings.mixer.mix(twist) if twist else None
        self._limiter.limit(None, now)
        wheels = self._wheel_limiter.cap(self.calibration.wheels(claim.command), max_speed)
        self._limiter.follow(self.settings.mixer.unmix(wheels))
        return wheels


def _names(names: Iterable[str]) -> str:
    return ", ".join(sorted(names))
