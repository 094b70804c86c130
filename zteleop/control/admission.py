"""What may move the robot: gate -> holds -> mux; and while nothing may, why."""

from collections.abc import Callable
from typing import NamedTuple

from zteleop.control.calibration import Calibration
from zteleop.control.deadlines import HEARD_LATE
from zteleop.control.foreign import Foreigners
from zteleop.control.gate import BEGUN_BEFORE, Gate, Refusal
from zteleop.control.hold import PAUSE, Hold, Holds
from zteleop.control.left import EARLY, Left
from zteleop.control.mux import Claim, Claims, Mux, Silences
from zteleop.control.proof import NEVER, Proof, called
from zteleop.control.refusals import LastRefusals
from zteleop.control.settings import DriveSettings
from zteleop.control.stop import Latch, stopped_by
from zteleop.messages import Beat, Pwm, State, Stop, Twist

RECENT = 1.0
"""s for which a refusal is told beside the reason to rest"""
LACKS_AN_ACT = (Refusal.OPERATOR_IDLE, Refusal.INTERRUPTED)
BEFORE: dict[State, Refusal] = {"fault": Refusal.BEFORE_REPAIR}
"""Why whatever began before the end of a hold does not count, where it is not the start."""


class Interruption(NamedTuple):
    """The last one."""

    ended: float = NEVER
    why: str = ""


class Verdict(NamedTuple):
    """What becomes of a command."""

    refusal: Refusal | None
    """None where it counts"""
    sender: int = 0
    age: float | None = None
    """s, of what moves; infinite where nobody can prove it"""


class Admission:
    """Judges commands, and keeps the claims and the reasons to rest; owns no clock and no chip."""

    def __init__(
        self,
        settings: DriveSettings,
        calibration: Calibration,
        epoch: int,
        now: float,
        keeps: Callable[[Silences], Claims] | None = None,
        grace: float = 0.0,
    ) -> None:
        self._settings = settings
        self._calibration = calibration
        self._sources = settings.known_sources
        self.gate = Gate(settings.deadlines, epoch, now, grace)
        self.silences = Silences(self._sources, settings.deadlines.operator)
        link_loss = settings.deadlines.link_loss
        self.mux: Claims = keeps(self.silences) if keeps else Mux(self._sources, self.silences, link_loss)
        self.foreign = Foreigners(self._sources, grace, now)
        self.holds = Holds()
        self.latch = Latch()
        self.refusals = LastRefusals()
        self.interruption = Interruption()
        self._left: Left | None = None
        """who drove last, and drives no more"""
        self._drove: int | None = None
        self._selected = now

    @property
    def driver(self) -> Claim | None:
        """The claim that drove last, unless it was let go or has lost its place."""
        return next((claim for claim in self.mux.claims if claim.sender == self._drove), None)

    @property
    def operator_silence(self) -> float:
        """s without an act, after which the robot rests; others may shorten it between two steps."""
        return self.silences.operator

    @operator_silence.setter
    def operator_silence(self, seconds: float) -> None:
        self.silences.operator = self.gate.operator_silence = seconds

    def beat(self, now: float) -> Beat:
        """Return what commands must echo from now on."""
        return Beat(self.gate.epoch, now, self.gate.floor)

    def late(self, now: float) -> float:
        """Return for how long the robot itself stood still since the last step, in seconds; else 0."""
        gap = now - self._selected
        return gap if gap > self._settings.deadlines.late_step else 0.0

    def interrupt(self, why: str, now: float, limit: float) -> None:
        """End an interruption: whoever counted in the last `limit` s goes on with the next act.

        What was said before counts for nothing, and whoever was not interrupted must begin anew.
        """
        self.gate.interrupt(now, limit)
        self.interruption = Interruption(now, why)
        self._selected = now

    def recall(self, source: str, sender: int, began: float, counted: float, now: float) -> None:
        """Keep the place of a claim that drove under another drive of this epoch; `interrupt` must follow."""
        if sender < 0:
            sender = self.foreign.recall(source, self.beat(began), now)
        self.gate.recall(sender, began, counted)
        self.mux.offer(Claim(source, sender, Twist.zero(), counted, counted, 0, counted, began))
        self._drove = sender

    def restart(self, epoch: int, now: float) -> None:
        """Forget every claim and begin a new epoch."""
        self.gate.restart(epoch, now)
        self.mux.clear()
        self.foreign.restart(now)
        self._left = None
        self._selected = now

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
        if hold := self.holds.drop(reason):
            began_with_it = hold.since <= self.interruption.ended  # which is the cause, then
            self.interrupt(
                self.interruption.why if began_with_it else why, now, self._settings.deadlines.link_loss
            )

    def free(self, reason: str, now: float) -> None:
        """Drop a reason to rest; whoever drives next must leave neutral after now."""
        if hold := self._drop(reason):
            self.gate.begin_after(now, BEFORE.get(hold.state, Refusal.NOT_FROM_NEUTRAL))

    def stop(self, said: Stop, now: float) -> bool:
        """Obey a stop or a release of one; True when that changed anything."""
        changed = self.latch.obey(said)
        if changed and self._left and self._left.is_idle:
            self._left = None  # the reason is the stop, from now on
        if changed and self.latch.stops:
            self.hold("stop", "stopped", stopped_by(self.latch.stops), now)
        elif changed:  # a release, perhaps of a stop that never arrived
            self._drop("stop")
            self.mux.clear()
            self.gate.begin_after(now, Refusal.BEFORE_RELEASE)
        return changed

    def withdraw(self, sender: int, now: float) -> None:
        """Let go what a sender held whose process is gone."""
        for claim in self.mux.claims:
            if claim.sender == sender:
                self._left = Left(_name(claim), now)
        self.mux.release(sender)

    def receive(self, source: str, command: Twist | Pwm, proof: Proof | None, now: float) -> Verdict:
        """Judge a command that arrived."""
        verdict = self._hear(source, command, proof, now)
        sender = proof.sender if proof else 0
        if verdict.refusal:
            self.refusals.note(source, sender, verdict.refusal, now)
            is_back = self._left and self._left.who == called(source, f"{sender:x}")
            if is_back and verdict.refusal is not Refusal.INTERRUPTED:
                self._left = None  # who was gone is here, and refused
        else:
            self.refusals.clear(source, sender)
        return verdict

    def select(self, now: float) -> Claim | None:
        """Return the claim that moves the robot now; None when nobody may drive."""
        self._selected = now
        claim = self.mux.select(now, self.interruption.ended) if not self.holds else None
        self._drove = claim.sender if claim else self._drove
        return claim

    def rest(self, now: float) -> tuple[State, str]:
        """Say why the robot rests, where it does."""
        state, why = self._rest(now)
        if self.holds:
            return state, why
        if state == "link lost" and now - self._last_heard > self._settings.deadlines.link_loss:
            state, why = "idle", f"nobody drives; {why}"  # nobody has a right to go on any more
        for (source, _), refused in [*self.refusals.recent(now, RECENT).items()][-1:]:
            if refused.why is not Refusal.INTERRUPTED:  # which the reason to rest says already
                why += f"; {called(source, f'{refused.sender:x}')} is refused: {refused.why}"
        return state, why

    @property
    def _last_heard(self) -> float:
        """When whoever drove last was heard last, or the last interruption ended."""
        heard = max((claim.at for claim in self.mux.claims), default=NEVER)
        return max(heard, self.interruption.ended, self._left.at if self._left else NEVER)

    def _drop(self, reason: str) -> Hold | None:
        """Drop a reason to rest; who was refused for it is not refused any more once there is no other."""
        hold = self.holds.drop(reason)
        if not self.holds:
            self.refusals.forget(Refusal.AT_REST)
        return hold

    def _hear(self, source: str, command: Twist | Pwm, proof: Proof | None, now: float) -> Verdict:
        if isinstance(command, Pwm) and not self._settings.mixer.takes_ticks:
            return Verdict(Refusal.NO_SUCH_CHANNEL)
        moving = self._moves(command)
        unproven = proof is None and self.foreign.trusted(source)
        if unproven and moving and now - self.interruption.ended <= self._settings.deadlines.max_age:
            # Nobody can prove that it was not said before the interruption ended, and queued meanwhile.
            self.foreign.hold_on(source, self.beat(now), now)
            return Verdict(Refusal.INTERRUPTED)
        if unproven:
            proof = self.foreign.vouch(source, moving, self.beat(now), now)
        refusal = self._judge(source, command, proof, moving, now)
        if proof and moving:
            return Verdict(refusal, proof.sender, now - (NEVER if unproven else proof.beat))
        return Verdict(refusal)

    def _rest(self, now: float) -> tuple[State, str]:
        if held := self.holds.strongest:
            return held.state, held.why
        newest = max(self.mux.claims, key=lambda claim: claim.at, default=None)
        if newest and newest.at <= (end := self.interruption.ended) and not self.silences.idle(newest, end):
            goes_on = "" if self._is_refused(newest, now) else f"; {_name(newest)} goes on with its next act"
            return "link lost", f"{self.interruption.why}{goes_on}"
        if newest is None:
            return self._left.told(self.operator_silence) if self._left else ("idle", "nobody drives")
        silence = self.silences.of(newest.source)
        fell_silent, unheard = newest.at + silence, newest.beat + silence + HEARD_LATE
        if self.silences.idle(newest, min(now, fell_silent, unheard)):  # the first deadline to pass
            idle = f"no act on {_name(newest)} for {now - newest.acted:.1f} s"
            return "operator idle", f"{idle}; the next one drives"
        if self._refused_for(newest, now) in BEGUN_BEFORE:
            return "idle", "nobody drives"  # it talks, and is told why that counts for nothing
        if self._waits_for_an_act(newest, now):
            words = f"was not heard for more than {silence:g} s, and waits for a new act"
            return "link lost", f"{_name(newest)} {words}"
        if now < fell_silent:
            return "link lost", f"{_name(newest)} has not heard the robot for {now - newest.beat:.1f} s"
        silent = self.refusals.silence(newest.source, newest.sender, newest.at, now)
        return "link lost", f"{_name(newest)} has been silent for {silent:.1f} s"

    def _waits_for_an_act(self, claim: Claim, now: float) -> bool:
        """Say whether a sender talks on, and all of it was decided before its link came back."""
        return self._refused_for(claim, now) is Refusal.INTERRUPTED

    def _judge(
        self, source: str, command: Twist | Pwm, proof: Proof | None, moving: bool, now: float
    ) -> Refusal | None:
        refusal = self.gate.judge(proof, moving, now, self.silences.of(source))
        is_over = refusal in (Refusal.NOT_FROM_NEUTRAL, Refusal.LAPSED)
        if is_over and self.holds and not self.holds.pass_by_themselves:
            refusal = Refusal.AT_REST  # whose claim has lapsed meanwhile is not told of a lost link
        if refusal or proof is None:
            if proof and refusal in LACKS_AN_ACT and not self.holds:
                self.gate.hear(proof, now)
            return refusal
        if not moving:
            self._let_go(proof.sender, now)
            return None
        if self.holds:
            return Refusal.INTERRUPTED if self.holds.pass_by_themselves else Refusal.AT_REST
        self._left = None
        claim = Claim(source, proof.sender, command, proof.acted, now, proof.seq, proof.beat, proof.began)
        if not self.mux.offer(claim):
            others = (one for one in self.mux.claims if one.source == source and one.sender != proof.sender)
            is_held = any(now - one.at <= self._settings.deadlines.link_loss for one in others)
            return Refusal.HELD if is_held else Refusal.WAITED
        self.gate.count(proof, now)
        return None

    def _is_refused(self, claim: Claim, now: float) -> bool:
        """Say whether a sender talks on, and lacks more than an act."""
        return self._refused_for(claim, now) not in (None, *LACKS_AN_ACT)

    def _refused_for(self, claim: Claim, now: float) -> Refusal | None:
        refused = self.refusals.recent(now, RECENT).get((claim.source, claim.sender))
        return refused.why if refused else None

    def _let_go(self, sender: int, now: float) -> None:
        """Release a claim; where an operator acted no more it is told, also if the input saw it first."""
        claim = next((claim for claim in self.mux.claims if claim.sender == sender), None)
        if claim and self.silences.idle(claim, now + EARLY):
            self._left = Left(_name(claim), now, is_idle=True)
        elif claim or not (self._left and self._left.is_idle):
            self._left = None  # a last neutral may arrive after the news of its sender's end
        self.mux.release(sender)

    def _moves(self, command: Twist | Pwm) -> bool:
        return not self._calibration.neutral(command) if isinstance(command, Pwm) else command.moves


def _name(claim: Claim) -> str:
    return called(claim.source, f"{claim.sender:x}")
