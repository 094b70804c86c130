"""Ways backward for ESCs that take a pulse below neutral for the brake, as most cars' do.

Such an ESC reverses only when it is told a second time, after neutral. For whoever asks for a speed it is
told so by itself: brake, neutral, and then what was asked for. Ticks are told as they are.
"""

from collections.abc import Mapping

from zteleop.control.mixer import Wheels
from zteleop.control.servo import Servo

BRAKES, RESTS = 0.1, 0.1
"""s for which it is told to brake, and then neutral, before a pulse below neutral drives backward"""


class Reversing:
    """Those of a vehicle's ESCs that do not simply reverse; times in s."""

    def __init__(self, servos: Mapping[str, Servo]) -> None:
        self._escs = {name: Esc(servo) for name, servo in servos.items() if servo.reverse != "direct"}

    def ask(self, wheels: Wheels) -> Wheels:
        """Return what to tell now, for wheels to turn so as soon as they can."""
        return {name: self._escs[name].ask(at) if name in self._escs else at for name, at in wheels.items()}

    def note(self, wheels: Wheels, now: float) -> None:
        """Note what each was told."""
        for name, esc in self._escs.items():
            esc.note(wheels[name], now)


class Esc:
    """What one of them makes of what it is told, as fractions of full range."""

    def __init__(self, servo: Servo) -> None:
        self._servo = servo
        self._reverses = False
        self._braked = False
        self._since: tuple[int, float] = (0, 0.0)
        """Which way it has been told to go, -1 to 1, and since when."""

    def ask(self, fraction: float) -> float:
        """Return what to tell it."""
        if self._way(fraction) >= 0 or self._reverses:
            return fraction
        if self._servo.reverse == "none":
            return 0.0
        return 0.0 if self._braked else fraction

    def note(self, fraction: float, now: float) -> None:
        """Note what it was told."""
        way = self._way(fraction)
        if way != self._since[0]:
            self._since = (way, now)
        lasts = now - self._since[1]
        if way > 0:
            self._braked = self._reverses = False
        elif way < 0:
            self._braked = self._braked or lasts >= BRAKES
        else:
            self._reverses = self._reverses or (self._braked and lasts >= RESTS)

    def _way(self, fraction: float) -> int:
        servo = self._servo
        if abs(servo.pulse_us(fraction) - servo.neutral_us) <= servo.dead_zone_us:
            return 0
        return 1 if fraction > 0 else -1
