"""What an actuator says of itself."""

from zteleop.control.drive import Drive, DriveSettings, Step
from zteleop.messages import DriveStatus, Pwm, Twist, Vehicle


def describe(settings: DriveSettings, tick_us: float) -> Vehicle:
    """Return what an input must know of a robot; `tick_us` is the chip's."""
    mixer, limits = settings.mixer, settings.limits
    return Vehicle(
        kind="ackermann" if mixer.max_steering_angle else "differential",
        channels=[servo.describe(name, tick_us) for name, servo in settings.servos.items()],
        max_speed=min(limits.speed or mixer.max_speed, mixer.max_speed),
        max_turn=min(limits.turn or mixer.max_turn, mixer.max_turn),
        wheelbase=mixer.wheelbase,
        max_steering_angle=mixer.max_steering_angle,
        operator_silence=settings.deadlines.operator,
    )


def status(drive: Drive, step: Step, written: float) -> DriveStatus:
    """Return what a robot does; `written` is when the step's pulses were on the chip."""
    claim = step.claim
    return DriveStatus(
        state=step.state,
        why=step.why,
        source=claim.source if claim else "",
        operator=f"{claim.sender:x}" if claim else "",
        wanted=_wanted(drive, step),
        applied=drive.settings.mixer.unmix(step.wheels),
        pulses=drive.calibration.pulses(step.wheels),
        seq=claim.seq if claim else 0,
        written=written,
        refused=drive.refused,
        clamped=drive.clamped,
    )


def _wanted(drive: Drive, step: Step) -> Twist:
    if step.claim is None:
        return Twist.planar()
    command = step.claim.command
    if isinstance(command, Pwm):
        return drive.settings.mixer.unmix(drive.calibration.wheels(command))
    return command
