"""An electronic speed controller and its motor: from a pulse to the speed of a wheel."""

from typing import Annotated

from msgspec import Meta, Struct

from zteleop.control.servo import Reverse, Servo

NotNegative = Annotated[float, Meta(ge=0, le=1000)]
DEADBAND_US = 15.0
"""that every ESC has"""
SHORTEST_US, LONGEST_US = 500.0, 2500.0


class EscSettings(Struct, frozen=True, forbid_unknown_fields=True):
    esc_deadband_us: NotNegative | None = None
    """To either side of neutral; None is what the servo's settings say, and 15 us at least."""
    motor_lag: Annotated[float, Meta(gt=0, le=10)] = 0.15
    """s to reach 63 % of a new speed."""
    rolling_resistance: NotNegative = 0.4
    """m/s^2 that stop a wheel nobody drives, beside the motor's drag."""
    grip: Annotated[float, Meta(gt=0, le=100)] = 6.0
    """m/s^2 that the tyres can take."""
    reverse: Reverse | None = None
    """What a pulse below neutral does; None is what the servo's settings say."""

    def throttle(self, servo: Servo, pulse_us: float | None) -> float:
        """Return the fraction, -1..1, that the motor is told; 0 without a pulse, as at neutral."""
        heard = fraction(servo, pulse_us)
        dead = self.esc_deadband_us
        if dead is None:
            dead = max(DEADBAND_US, servo.dead_zone_us)
        if heard is None or abs(servo.pulse_us(heard) - servo.neutral_us) <= dead:
            return 0.0
        return heard

    def spin(self, speed: float, wanted: float, dt: float) -> float:
        """Return the speed in m/s after `dt` of wanting another."""
        change = (wanted - speed) * min(1.0, dt / self.motor_lag)
        if wanted == 0.0:
            drag = min(self.rolling_resistance * dt, abs(speed + change))
            change -= drag if speed > 0 else -drag
        after = speed + max(-self.grip * dt, min(self.grip * dt, change))
        return 0.0 if wanted == 0.0 and after * speed < 0 else after  # braking never ends in reverse


class Esc:
    """What one speed controller remembers: whether a pulse below neutral brakes, or drives backward."""

    def __init__(self, settings: EscSettings) -> None:
        self._settings = settings
        self._braked = False
        """below neutral since it was last above"""
        self._tapped = False
        """and at neutral after that"""

    def drive(self, speed: float, servo: Servo, pulse_us: float | None, most: float, dt: float) -> float:
        """Return the speed in m/s of a wheel after `dt` s of a pulse; `most` is at full throttle."""
        settings, throttle = self._settings, self._settings.throttle(servo, pulse_us)
        self._note(throttle)
        style = settings.reverse or servo.reverse
        if throttle < 0 and (style == "none" or (style == "double_tap" and not self._tapped)):
            slower = settings.grip * dt
            return max(0.0, speed - slower) if speed > 0 else min(0.0, speed + slower)
        return settings.spin(speed, throttle * most, dt)

    def _note(self, throttle: float) -> None:
        if throttle > 0:
            self._braked = self._tapped = False
        elif throttle == 0:
            self._tapped = self._braked
        else:
            self._braked = True


def fraction(servo: Servo, pulse_us: float | None) -> float | None:
    """Return the fraction, -1..1, a pulse asks for; None when it is none that a servo understands."""
    if pulse_us is None or not SHORTEST_US <= pulse_us <= LONGEST_US:
        return None
    return max(-1.0, min(1.0, servo.fraction(pulse_us)))
