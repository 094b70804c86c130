"""Why the robot moves as it does, or does not: one sentence for each layer between a key and a wheel."""

from collections.abc import Iterator

from msgspec.structs import asdict

from zteleop.control import curvature
from zteleop.control.cap import Bound
from zteleop.control.evidence import STANDS, Evidence
from zteleop.control.hold import Hold
from zteleop.control.mixer import Wheels
from zteleop.control.mux import Claim
from zteleop.control.proof import NEVER, called
from zteleop.control.snapshot import Snapshot
from zteleop.control.unmet import aside
from zteleop.messages import Layer, Pwm, Twist

OLD = 0.1
"""s after which pulses are no longer what the robot means now"""
REFUSES = 1.0
"""s after which a refusal is no longer what the gate does"""
_LEAST = 0.005
"""m/s or rad/s below which two twists are one, and a speed is none."""


def layers(seen: Snapshot, chip: Evidence) -> list[Layer]:
    """Return the sentences, from the operator to the wheels."""
    return [
        Layer("operator", _operator(seen)),
        Layer("gate", _gate(seen)),
        Layer("mux", _mux(seen)),
        Layer("rest", _rest(seen)),
        Layer("cap", _cap(seen)),
        Layer("limiter", _limiter(seen)),
        Layer("wheels", _wheels(seen, chip)),
    ]


def slowed(seen: Snapshot) -> str:
    """Return why the vehicle may not go as fast as it can; nothing when it may."""
    claim, bound = seen.step.claim, seen.step.bound
    if top_speed(seen) < bound.speed:
        return _turn_bound(seen)
    if bound.by == "strain":
        return seen.strain
    if bound.by == "parameter":
        return f"limits.speed is set to {_metres(bound.speed)} m/s"
    if claim is None or bound.by == "vehicle":
        return ""
    if bound.by == "source":
        return f"{claim.source} may drive no faster here" if bound.speed >= _LEAST else _kept(claim.source)
    return _age(seen, claim)  # the link


def top_speed(seen: Snapshot) -> float:
    """Return the highest speed of now in m/s, on the curve that is asked for."""
    mixer, asked = seen.settings.mixer, wanted(seen)
    turn, most = abs(asked.angular.z), seen.limits.turn_of(mixer)
    if turn == 0.0 or most >= mixer.max_turn or not curvature.rolls(asked.linear.x):
        return seen.step.bound.speed
    return min(seen.step.bound.speed, abs(asked.linear.x) / turn * most)


def _turn_bound(seen: Snapshot) -> str:
    return f"limits.turn is {seen.limits.turn_of(seen.settings.mixer):g} rad/s"


def wanted(seen: Snapshot) -> Twist:
    """Return what the operator asks for as a twist; rest when nobody does."""
    if seen.step.claim is None:
        return Twist.planar()
    command = seen.step.claim.command
    if isinstance(command, Pwm):
        return _made(seen, seen.calibration.wheels(command))
    return command


def applied(seen: Snapshot) -> Twist:
    """Return what the wheels are to make of it."""
    return _made(seen, seen.step.wheels)


def _made(seen: Snapshot, wheels: Wheels) -> Twist:
    """Return the body's twist: a car that stands turns its front wheels, and not itself."""
    twist = seen.settings.mixer.unmix(wheels)
    stands = seen.settings.mixer.steers and not curvature.rolls(twist.linear.x)
    return Twist.planar() if stands else twist


def _operator(seen: Snapshot) -> str:
    claim = seen.step.claim
    if claim is None:
        return "nobody operates"
    acted = f"{seen.now - claim.acted:.1f} s ago"
    return f"{_sender(claim)} operates, acted {acted} and asks for {_asked(claim)}"


def _gate(seen: Snapshot) -> str:
    told: dict[bool, list[str]] = {True: [], False: []}
    for (source, _), refused in seen.refused.items():
        since, ago = seen.now - refused.since, seen.now - refused.at
        often = "once" if refused.times == 1 else f"{refused.times} times in {since:.1f} s"
        who = called(source, f"{refused.sender:x}")
        told[ago <= REFUSES].append(f"{who}: {refused.why} ({often}, last {ago:.1f} s ago)")
    now = f"refuses {'; '.join(told[True]) or 'nobody'}"
    return f"{now}; lately refused {'; '.join(told[False])}" if told[False] else now


def _mux(seen: Snapshot) -> str:
    claim = seen.step.claim
    waiting = [_sender(other) for other in seen.claims if other is not claim]
    priority = seen.settings.known_sources[claim.source].priority if claim else 0
    chosen = f"{claim.source} drives with priority {priority}" if claim else "nobody drives"
    return f"{chosen}; {', '.join(waiting)} {'waits' if len(waiting) == 1 else 'wait'}" if waiting else chosen


def _rest(seen: Snapshot) -> str:
    if seen.holds:
        return "; ".join(f"{hold.state} {_lasting(hold, seen.now)}: {hold.why}" for hold in seen.holds)
    return "free to move" if seen.step.claim else f"{seen.step.state}: {seen.step.why}"


def _lasting(hold: Hold, now: float) -> str:
    return "since before its start" if hold.since == NEVER else f"for {now - hold.since:.1f} s"


def _cap(seen: Snapshot) -> str:
    claim, bound = seen.step.claim, seen.step.bound
    if bound.by != "vehicle":
        return f"{_metres(bound.speed)} of {_metres(seen.top)} m/s: {slowed(seen)}{_distance(seen)}"
    return f"{_metres(seen.top)} m/s: {_age(seen, claim) if claim else 'nobody drives'}"


def _kept(source: str) -> str:
    return f"{source} may move nothing here, as while zteleop calibrate runs"


def _age(seen: Snapshot, claim: Claim) -> str:
    if seen.foreign:
        return f"commands of {claim.source} cannot prove their age"
    return f"commands of {claim.source} are up to {seen.step.bound.latency * 1000:.0f} ms old"


def _distance(seen: Snapshot) -> str:
    if seen.step.bound.by != "link":
        return ""
    distance = seen.settings.cap.stopping_distance
    within = f"within {distance:g} m" if distance else "as soon as on a good link"
    return f", and it must stop {within}"


def _metres(speed: float) -> str:
    return f"{round(speed, 2):g}"


def _limiter(seen: Snapshot) -> str:
    if seen.step.claim is None:
        narrowed = ", ".join(_narrowed(seen))
        return f"nothing to limit; set narrower: {narrowed}" if narrowed else "nothing to limit"
    asked, made = wanted(seen), applied(seen)
    if _near(asked, made) and not _ends(seen, seen.step.claim) and not aside(asked):
        return "passes it on as asked"
    bounds = "; ".join(_bounds(seen, seen.step.claim, asked, made)) or "the wheels can do no better"
    others = ", ".join(limit for limit in _narrowed(seen) if limit.partition(" ")[0] not in bounds)
    more = f" (set narrower: {others})" if others else ""
    return f"makes it {_twist(made)}: {bounds}{more}"


def _narrowed(seen: Snapshot) -> Iterator[str]:
    """Yield the limits that somebody has set narrower than the settings say, and to what."""
    widest = asdict(seen.settings.limits.in_numbers(seen.settings.mixer))
    for name, value in asdict(seen.limits).items():
        if value is not None and value != widest[name]:
            yield f"limits.{name} {value:g}"


def _bounds(seen: Snapshot, claim: Claim, asked: Twist, made: Twist) -> Iterator[str]:
    """Yield what bounds a claim."""
    yield from _ends(seen, claim)
    if besides := aside(asked):
        yield besides
    mixer, limits = seen.settings.mixer, seen.limits
    speed = seen.step.bound.speed
    if abs(asked.linear.x) > speed + _LEAST:
        yield _top(claim.source, seen.step.bound)
    best = mixer.unmix(mixer.mix(asked))
    top = top_speed(seen)
    if abs(asked.linear.x) > top + _LEAST and top < speed:
        yield slowed(seen)
    if abs(made.linear.x) < min(abs(best.linear.x), top) - _LEAST:
        yield f"speed changes by {limits.acceleration:g} m/s^2"
    if limits.pulse_duty < 1:
        yield f"the throttle is obeyed {limits.pulse_duty:.0%} of the time"
    on_the_spot = not curvature.rolls(asked.linear.x)
    if mixer.steers and not curvature.rolls(made.linear.x):
        if on_the_spot:
            yield "a car that stands only turns its front wheels"
    elif on_the_spot and limits.turn_of(mixer) < min(mixer.max_turn, abs(asked.angular.z)):
        yield _turn_bound(seen)
    elif abs(_bend(made)) < abs(_bend(asked)) - _LEAST:
        yield "it turns no tighter"


def _ends(seen: Snapshot, claim: Claim) -> list[str]:
    """Return where channels end of which more is asked, in ticks."""
    ends = seen.calibration.ends(claim.command) if isinstance(claim.command, Pwm) else {}
    return [f"{name} ends at {ticks} ticks" for name, ticks in ends.items()]


def _top(source: str, bound: Bound) -> str:
    """Return what bounds the speed: the vehicle itself, the settings of its source, or the cap."""
    speed = f"{_metres(bound.speed)} m/s"
    words = {
        "vehicle": f"it does {speed} at most",
        "source": f"{source} may drive {speed} here" if bound.speed >= _LEAST else _kept(source),
        "parameter": f"limits.speed is set to {speed}",
    }
    return words.get(bound.by, f"it may do {speed} now")


def _wheels(seen: Snapshot, chip: Evidence) -> str:
    """Return what the chip took, however long ago, and what is known of a stop."""
    pulses = seen.calibration.pulses(chip.pulse_us)
    said = [", ".join(f"{p.name} {p.pulse_us:.0f} us = {p.duty_ticks} ticks" for p in pulses)]
    said += _dead_zones(seen, chip)
    if seen.now - chip.written > OLD:
        said.append(f"which the chip took {seen.now - chip.written:.1f} s ago, and nothing since")
    if seen.stopped:
        said.append(STANDS[chip.confirmed])
    return "; ".join(said)


def _dead_zones(seen: Snapshot, chip: Evidence) -> Iterator[str]:
    """Yield which motors are asked for something that does not turn them yet."""
    for name, servo in seen.settings.servos.items():
        off = abs(chip.pulse_us.get(servo.channel, servo.neutral_us) - servo.neutral_us)
        if seen.step.claim and 0 < off <= servo.dead_zone_us:
            yield f"{name} is in its motor's dead zone, and does not turn it yet"


def _asked(claim: Claim) -> str:
    if isinstance(claim.command, Pwm):
        return f"steering {claim.command.steering_ticks}, throttle {claim.command.throttle_ticks} ticks"
    return _twist(claim.command)


def _sender(claim: Claim) -> str:
    return called(claim.source, f"{claim.sender:x}")


def _twist(twist: Twist) -> str:
    speed, turn = (round(value, 2) + 0.0 for value in (twist.linear.x, twist.angular.z))  # no minus zero
    return f"{speed:+.2f} m/s {turn:+.2f} rad/s"


def _bend(twist: Twist) -> float:
    return curvature.of(twist.linear.x, twist.angular.z)


def _near(one: Twist, other: Twist) -> bool:
    return abs(one.linear.x - other.linear.x) < _LEAST and abs(one.angular.z - other.angular.z) < _LEAST
