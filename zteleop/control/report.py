"""What an actuator says of itself."""

from collections.abc import Sequence

from zteleop.control.drive import Drive, Step
from zteleop.control.evidence import Evidence
from zteleop.control.explain import applied, slowed, top_speed, wanted
from zteleop.control.gate import Refusal
from zteleop.control.limiter import Limits
from zteleop.control.mux import Claim
from zteleop.control.proof import called
from zteleop.control.refusals import Turned
from zteleop.control.settings import DriveSettings
from zteleop.control.snapshot import Snapshot, snapshot
from zteleop.messages import DriveStatus, Pulse, Refusals, Refused, Vehicle


def to_vehicle(
    settings: DriveSettings, tick_us: float, ready: bool = True, allowed: Limits | None = None
) -> Vehicle:
    """Return what an input must know of a robot; `tick_us` is the chip's, `allowed` what binds it now."""
    mixer, limits = settings.mixer, settings.limits
    most = limits.speed_of(mixer)
    turn = mixer.max_turn * most / mixer.max_speed if mixer.steers else mixer.max_turn
    return Vehicle(
        kind=mixer.kind,
        channels=[servo.to_channel(name, tick_us) for name, servo in settings.servos.items()],
        tick_us=tick_us,
        ready=ready,
        max_speed=most,
        allowed_speed=(allowed or limits).speed_of(mixer),
        max_turn=min(limits.turn_of(mixer), turn),
        wheelbase=mixer.wheelbase,
        max_steering_angle=mixer.max_steering_angle,
        operator_silence=settings.deadlines.operator,
    )


def in_dead_zone(vehicle: Vehicle, pulses: Sequence[Pulse]) -> str:
    """Say which channel asks its motor to turn, and by too little; nothing where none does."""
    ticks = {pulse.name: pulse.duty_ticks for pulse in pulses}
    for channel in vehicle.channels:
        if channel.is_dead(ticks.get(channel.name, channel.neutral_ticks)):
            return f"its {channel.name} is in the motor's dead zone"
    return ""


def status(drive: Drive, step: Step, chip: Evidence, now: float, unkept: str = "") -> DriveStatus:
    """Return what a robot does; `unkept` says why its stops are on no disk."""
    claim, seen = step.claim, snapshot(drive, step, now)
    return DriveStatus(
        state=step.state,
        why=step.why,
        source=claim.source if claim else "",
        operator=f"{claim.sender:x}" if claim else "",
        wanted=wanted(seen),
        applied=applied(seen),
        pulses=drive.calibration.pulses(chip.pulse_us),
        seq=claim.seq if claim else 0,
        written=chip.written,
        stops=list(drive.admission.latch.stops),
        unkept=unkept,
        confirmed=chip.confirmed,
        refused=drive.admission.refusals.count,
        clamped=drive.clamped,
        max_speed=top_speed(seen),
        latency=step.bound.latency,
        slowed=slowed(seen),
        released=drive.admission.latch.released,
    )


def overridden(seen: Snapshot, claim: Claim) -> str | None:
    """Return why a claim that counts does not drive; None where it does, or is about to, or nobody does."""
    driver = seen.step.claim
    if driver is None or driver.sender == claim.sender:
        return None
    higher, own = (seen.settings.known_sources[one.source].priority for one in (driver, claim))
    if own > higher:
        return None  # it came after the step, and drives with the next
    ranks = f"priority {higher} over {own}"
    who = called(driver.source, f"{driver.sender:x}")
    return f"{who} drives, with {ranks}; this one is obeyed when that one is done"


def refusals(drive: Drive, refused: dict[int, Turned], now: float) -> Refusals:
    """Return what a robot says to those whose commands do not count."""
    rest = drive.admission.holds.strongest
    told = [
        Refused(f"{who:x}", last.source, *_why(drive, last), since=now - last.since)
        for who, last in refused.items()
    ]
    return Refusals(told, rest.why if rest else "", drive.admission.latch.released)


def _why(drive: Drive, last: Turned) -> tuple[str, str]:
    """Return why one is refused now, and whose source it is where that is why.

    Whoever drove may have gone since, or been stopped.
    """
    if drive.admission.holds and not isinstance(last.why, Refusal):
        return Refusal.AT_REST, ""  # it waited for who drove, and does so no more
    if last.why is not Refusal.HELD:
        return last.why, ""
    if drive.admission.holds:
        return Refusal.AT_REST, ""
    holders = (one for one in drive.admission.mux.claims if one.source == last.source)
    holder = next((called(one.source, f"{one.sender:x}") for one in holders), "")
    return (Refusal.HELD, holder) if holder else (Refusal.WAITED, "")
