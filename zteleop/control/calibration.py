"""All channels of a vehicle on one chip: wheels to pulses, ticks to wheels."""

from collections.abc import Mapping

from zteleop.control.mixer import Wheels
from zteleop.control.servo import Servo
from zteleop.errors import ConfigError
from zteleop.messages import Pulse, Pwm


def check_pulses(servos: Mapping[str, Servo], longest_us: float) -> None:
    """Raise ConfigError for a servo with pulses no shorter than a chip's longest, which its period bounds."""
    for name, servo in servos.items():
        if (widest := max(servo.min_us, servo.max_us)) >= longest_us:
            raise ConfigError(
                f"drive.servos.{name}: its longest pulse, {widest:.0f} us, does not fit a period of "
                f"{longest_us:.0f} us; lower the driver's frequency_hz"
            )


class Calibration:
    """The servos, and the chip's real tick in microseconds."""

    def __init__(self, servos: Mapping[str, Servo], tick_us: float) -> None:
        self._servos = servos
        self._tick_us = tick_us
        self.rest: Wheels = dict.fromkeys(servos, 0.0)
        self.neutral_us = self.pulse_us(self.rest)

    def pulse_us(self, wheels: Wheels) -> dict[int, float]:
        """Return each channel's pulse width, within its ends."""
        return {servo.channel: servo.pulse_us(wheels[name]) for name, servo in self._servos.items()}

    def pulses(self, pulse_us: Mapping[int, float]) -> list[Pulse]:
        """Return each channel's pulse in every unit."""
        widths = {name: pulse_us[servo.channel] for name, servo in self._servos.items()}
        return [
            Pulse(name, servo.channel, servo.fraction(width), width, round(width / self._tick_us))
            for (name, servo), width in zip(self._servos.items(), widths.values(), strict=True)
        ]

    def wheels(self, pwm: Pwm) -> Wheels:
        """Return the wheels that ticks ask for, beyond 1 where they exceed the range."""
        return {name: self._servos[name].fraction(width) for name, width in self._widths(pwm).items()}

    def at_rest(self, pulse_us: Mapping[int, float | None]) -> bool:
        """Say whether these pulses are neutral, to half a tick, or none at all."""
        return all(
            width is None or abs(width - self.neutral_us[channel]) <= self._tick_us / 2
            for channel, width in pulse_us.items()
        )

    def ends(self, pwm: Pwm) -> dict[str, int]:
        """Return the end, in ticks, of each channel whose ticks lie beyond it by more than rounding."""
        found = {}
        for name, width in self._widths(pwm).items():
            end = self._servos[name].pulse_us(self._servos[name].fraction(width))
            if abs(width - end) > self._tick_us / 2:
                found[name] = round(end / self._tick_us)
        return found

    def neutral(self, pwm: Pwm) -> bool:
        """Say whether ticks are those of rest, by no more than rounding."""
        return all(
            abs(width - self._servos[name].neutral_us) <= self._tick_us / 2
            for name, width in self._widths(pwm).items()
        )

    def _widths(self, pwm: Pwm) -> dict[str, float]:
        return {
            "steering": pwm.steering_ticks * self._tick_us,
            "throttle": pwm.throttle_ticks * self._tick_us,
        }
