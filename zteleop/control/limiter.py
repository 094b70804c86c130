"""Bounds on what passed the gate. None passes through: nothing softens a stop."""

from typing import Annotated

from msgspec import Meta, Struct
from msgspec.structs import replace

from zteleop.control import curvature
from zteleop.control.mixer import Mixer, Wheels
from zteleop.control.servo import Servo
from zteleop.messages import Twist

Positive = Annotated[float, Meta(gt=0, le=1000)]


class Limits(Struct, frozen=True, forbid_unknown_fields=True):
    """Bounds of motion; None is the vehicle's own."""

    speed: Positive | None = None
    """m/s"""
    turn: Positive | None = None
    """rad/s"""
    acceleration: Positive = 3.0
    """m/s^2"""
    turn_acceleration: Positive = 10.0
    """rad/s^2; a car's steering follows its curvature instead"""
    pulse_duty: Annotated[float, Meta(gt=0, le=1)] = 1.0
    """share of the time for which the throttle is obeyed"""
    pulse_duty_period: Annotated[float, Meta(gt=0, le=10)] = 0.5
    """s"""

    def speed_of(self, mixer: Mixer, cap: float | None = None) -> float:
        """Return the highest speed, in m/s, of a vehicle, and of a source that is capped."""
        return min(bound for bound in (cap, self.speed, mixer.max_speed) if bound is not None)

    def in_numbers(self, mixer: Mixer) -> "Limits":
        """Return the same limits, with a number where it is the vehicle that says so."""
        return replace(self, speed=self.speed_of(mixer), turn=self.turn_of(mixer))

    def turn_of(self, mixer: Mixer) -> float:
        """Return the highest yaw rate, in rad/s, of a vehicle."""
        return min(self.turn or mixer.max_turn, mixer.max_turn)


class TwistLimiter:
    """Follows the wanted twist no faster than the limits allow, on the same curve."""

    def __init__(self, limits: Limits, mixer: Mixer) -> None:
        self._mixer = mixer
        self.limits = limits
        self._last = (0.0, 0.0)
        self._then: float | None = None

    @property
    def limits(self) -> Limits:
        """The bounds that hold; others may take their place at any time."""
        return self._limits

    @limits.setter
    def limits(self, limits: Limits) -> None:
        self._limits = limits
        self._speed = limits.speed_of(self._mixer)
        self._turn = limits.turn_of(self._mixer)

    def follow(self, applied: Twist | None) -> None:
        """Start the next ramp from what was applied by other means; None is rest."""
        self._last = (applied.linear.x, applied.angular.z) if applied else (0.0, 0.0)

    def limit(self, wanted: Twist | None, now: float, max_speed: float | None = None) -> Twist | None:
        """Return the next twist, at most `max_speed` m/s fast."""
        dt = now - self._then if self._then is not None else 0.0
        self._then = now
        if wanted is None:
            self.follow(None)
            return None
        bound = self._speed if max_speed is None else max_speed
        speed, turn = self._scale(wanted.linear.x, wanted.angular.z, bound)
        if self._mixer.steers:
            self._last = self._steer(speed, curvature.of(wanted.linear.x, wanted.angular.z), dt)
        else:
            self._last = self._rotate(speed, turn, dt)
        return Twist.planar(*self._last)

    def _scale(self, speed: float, turn: float, max_speed: float) -> tuple[float, float]:
        excess = max(1.0, abs(speed) / min(max_speed, self._speed))
        if curvature.rolls(speed) or not self._mixer.steers:
            excess = max(excess, abs(turn) / self._turn)
        return speed / excess, turn / excess

    def _steer(self, speed: float, bend: float, dt: float) -> tuple[float, float]:
        speed = _approach(self._last[0], speed, self._limits.acceleration * dt)
        return speed, curvature.turn(speed, bend)

    def _rotate(self, speed: float, turn: float, dt: float) -> tuple[float, float]:
        reached = _approach(self._last[0], speed, self._limits.acceleration * dt)
        share = reached / speed if speed else 1.0
        if 0 < share < 1:
            turn *= share
        return reached, _approach(self._last[1], turn, self._limits.turn_acceleration * dt)


class WheelLimiter:
    """Slews each channel, and obeys the driven ones for a share of the time only."""

    def __init__(self, limits: Limits, mixer: Mixer, servos: dict[str, Servo]) -> None:
        self._mixer = mixer
        self._servos = servos
        self.limits = limits
        self._rest: Wheels = dict.fromkeys(servos, 0.0)
        self._last: Wheels = self._rest
        self._then: float | None = None

    @property
    def limits(self) -> Limits:
        """The bounds that hold; others may take their place at any time."""
        return self._limits

    @limits.setter
    def limits(self, limits: Limits) -> None:
        self._limits = limits
        self._rates = {name: servo.slew_rate for name, servo in self._servos.items()}
        if self._mixer.takes_ticks and self._rates["throttle"] is None:  # ticks pass the limiter of twists by
            self._rates["throttle"] = limits.acceleration / self._mixer.max_speed

    def limit(self, wheels: Wheels | None, now: float) -> Wheels | None:
        """Return the next position of each wheel."""
        dt = now - self._then if self._then is not None else 0.0
        self._then = now
        if wheels is None:
            self._last = self._rest
            return None
        self._last = {name: self._slew(name, wheels[name], dt) for name in wheels}
        return self._last if self._obeys(now) else self._coast(self._last)

    def cap(self, wheels: Wheels, max_speed: float | None) -> Wheels:
        """Bound a command that names pulses: to full range, to a speed in m/s, and to the yaw rate."""
        speed = self._limits.speed_of(self._mixer, max_speed)
        ends = {name: speed / self._mixer.max_speed if name in self._mixer.driven else 1.0 for name in wheels}
        bounded = {name: max(-ends[name], min(ends[name], fraction)) for name, fraction in wheels.items()}
        turn = abs(self._mixer.unmix(bounded).angular.z)
        return self._slow(bounded, turn / self._limits.turn_of(self._mixer))

    def _slow(self, wheels: Wheels, excess: float) -> Wheels:
        """Divide what is driven by an excess of more than 1: a car keeps its curve, as with a twist."""
        if excess <= 1:
            return wheels
        driven = self._mixer.driven
        return {name: at / excess if name in driven else at for name, at in wheels.items()}

    def _slew(self, name: str, fraction: float, dt: float) -> float:
        rate = self._rates[name]
        return fraction if rate is None else _approach(self._last[name], fraction, rate * dt)

    def _obeys(self, now: float) -> bool:
        return (
            now % self._limits.pulse_duty_period <= self._limits.pulse_duty * self._limits.pulse_duty_period
        )

    def _coast(self, wheels: Wheels) -> Wheels:
        return {name: 0.0 if name in self._mixer.driven else wheels[name] for name in wheels}


def _approach(value: float, target: float, step: float) -> float:
    return value + max(-step, min(step, target - value))
