"""Why the robot moves as it does, or does not: one sentence for each layer between a key and a wheel."""

from collections.abc import Iterator

from zteleop.control import curvature
from zteleop.control.cap import Bound
from zteleop.control.drive import Drive, Step
from zteleop.control.evidence import STANDS, Evidence
from zteleop.control.mux import Claim
from zteleop.control.proof import called
from zteleop.messages import Layer, Pwm, Twist

RECENT = 10.0
"""s for which a refusal is worth a sentence."""
OLD = 0.1
"""s after which pulses are no longer what the robot means now"""
_LEAST = 0.005
"""m/s or rad/s below which two twists are one."""


def layers(drive: Drive, step: Step, chip: Evidence, now: float) -> list[Layer]:
    """Return the sentences, from the operator to the wheels."""
    return [
        Layer("operator", _operator(step, now)),
        Layer("gate", _gate(drive, now)),
        Layer("mux", _mux(drive, step, now)),
        Layer("rest", _rest(drive, step, now)),
        Layer("cap", _cap(drive, step)),
        Layer("limiter", _limiter(drive, step)),
        Layer("wheels", _wheels(drive, chip, now)),
    ]


def _operator(step: Step, now: float) -> str:
    claim = step.claim
    if claim is None:
        return "nobody operates"
    return f"{_sender(claim)} operates, acted {now - claim.acted:.1f} s ago and asks for {_asked(claim)}"


def _mux(drive: Drive, step: Step, now: float) -> str:
    heard = drive.admission
    claims = [claim for claim in heard.mux.claims if not heard.silences.silent(claim, now)]
    waiting = [_sender(claim) for claim in claims if claim is not step.claim]
    priority = drive.settings.known_sources[step.claim.source].priority if step.claim else 0
    chosen = f"{step.claim.source} drives with priority {priority}" if step.claim else "no claim counts"
    return f"{chosen}; {', '.join(waiting)} waits" if waiting else chosen


def _gate(drive: Drive, now: float) -> str:
    recent = [f"{name}: {found}" for name, found in _refusals(drive, now)]
    return f"refuses {'; '.join(recent)}" if recent else "refuses nobody"


def _refusals(drive: Drive, now: float) -> Iterator[tuple[str, str]]:
    for source, refused in drive.admission.refusals.recent(now, RECENT).items():
        since, ago = now - refused.since, now - refused.at
        yield source, f"{refused.why} ({refused.times} times in {since:.1f} s, last {ago:.1f} s ago)"


def _rest(drive: Drive, step: Step, now: float) -> str:
    if holds := drive.admission.holds.in_order:
        return "; ".join(f"{hold.state} for {now - hold.since:.1f} s: {hold.why}" for hold in holds)
    return "free to move" if step.claim else f"{step.state}: {step.why}"


def _cap(drive: Drive, step: Step) -> str:
    bound, top = step.bound, _metres(drive.movement.cap.top)
    if bound.by != "vehicle":
        return f"{_metres(bound.speed)} of {top} m/s: {slowed(drive, step)}{_distance(drive, step)}"
    return f"{top} m/s: {_age(drive, step.claim, bound) if step.claim else 'nobody drives'}"


def slowed(drive: Drive, step: Step) -> str:
    """Return why the vehicle may not go as fast as it can; nothing when it may."""
    claim, bound = step.claim, step.bound
    if bound.by == "strain":
        return drive.movement.cap.strain.why
    if claim is None or bound.by == "vehicle":
        return ""
    if bound.by == "source":
        return f"{claim.source} may drive no faster here"
    return _age(drive, claim, bound)


def _age(drive: Drive, claim: Claim, bound: Bound) -> str:
    if drive.admission.foreign.includes(claim):
        return f"commands of {claim.source} cannot prove their age"
    return f"commands of {claim.source} are up to {bound.latency * 1000:.0f} ms old"


def _distance(drive: Drive, step: Step) -> str:
    if step.bound.by != "link":
        return ""
    distance = drive.settings.cap.stopping_distance
    return f", and it must stop {f'within {distance:g} m' if distance else 'as soon as on a good link'}"


def _metres(speed: float) -> str:
    return f"{round(speed, 2):g}"


def _limiter(drive: Drive, step: Step) -> str:
    if step.claim is None:
        return "nothing to limit"
    asked, applied = wanted(drive, step), drive.settings.mixer.unmix(step.wheels)
    if _near(asked, applied):
        return "passes it on as asked"
    bounds = "; ".join(_bounds(drive, step, step.claim, asked, applied)) or "the wheels can do no better"
    return f"makes it {_twist(applied)}: {bounds}"


def _bounds(drive: Drive, step: Step, claim: Claim, asked: Twist, applied: Twist) -> Iterator[str]:
    """Yield what bounds a claim."""
    mixer, limits = drive.settings.mixer, drive.settings.limits
    speed = step.bound.speed
    if abs(asked.linear.x) > speed + _LEAST:
        capped = step.bound.by in ("link", "strain")
        yield f"the cap is {_metres(speed)} m/s" if capped else f"{claim.source} may drive {speed:g} m/s here"
    best = mixer.unmix(mixer.mix(asked))
    if abs(applied.linear.x) < min(abs(best.linear.x), speed) - _LEAST:
        yield f"speed changes by {limits.acceleration:g} m/s^2"
    if limits.pulse_duty < 1:
        yield f"the throttle is obeyed {limits.pulse_duty:.0%} of the time"
    if abs(_bend(applied)) < abs(_bend(asked)) - _LEAST:
        yield "it turns no tighter"


def _wheels(drive: Drive, chip: Evidence, now: float) -> str:
    """Return what the chip took, however long ago, and what is known of a stop."""
    pulses = drive.calibration.pulses(chip.pulse_us)
    said = [", ".join(f"{p.name} {p.pulse_us:.0f} us = {p.duty_ticks} ticks" for p in pulses)]
    if now - chip.written > OLD:
        said.append(f"which the chip took {now - chip.written:.1f} s ago, and nothing since")
    if drive.admission.latch.stops:
        said.append(STANDS[chip.confirmed])
    return "; ".join(said)


def wanted(drive: Drive, step: Step) -> Twist:
    """Return what the operator asks for as a twist; rest when nobody does."""
    if step.claim is None:
        return Twist.planar()
    command = step.claim.command
    if isinstance(command, Pwm):
        return drive.settings.mixer.unmix(drive.calibration.wheels(command))
    return command


def _asked(claim: Claim) -> str:
    if isinstance(claim.command, Pwm):
        return f"steering {claim.command.steering_ticks}, throttle {claim.command.throttle_ticks} ticks"
    return _twist(claim.command)


def _sender(claim: Claim) -> str:
    return called(claim.source, f"{claim.sender:x}")


def _twist(twist: Twist) -> str:
    return f"{twist.linear.x:+.2f} m/s {twist.angular.z:+.2f} rad/s"


def _bend(twist: Twist) -> float:
    return curvature.of(twist.linear.x, twist.angular.z)


def _near(one: Twist, other: Twist) -> bool:
    return abs(one.linear.x - other.linear.x) < _LEAST and abs(one.angular.z - other.angular.z) < _LEAST
