"""Two driven wheels, each with its own speed controller; base_link between them."""

from collections.abc import Mapping

from zteleop.control.mixer import Differential
from zteleop.control.servo import Servo
from zteleop.sim.body import Body, Disc, Pulses
from zteleop.sim.esc import EscSettings

RADIUS = 0.6
"""of the track"""


class Tank(Body):
    def __init__(
        self, mixer: Differential, servos: Mapping[str, Servo], settings: EscSettings | None = None
    ) -> None:
        super().__init__()
        self._mixer = mixer
        self.discs = (Disc(0.0, RADIUS * mixer.track),)
        self._settings = settings or EscSettings()
        self._servos = servos["left"], servos["right"]
        self.wheel_speeds = (0.0, 0.0)
        """m/s, left and right."""

    def move(self, pulse_us: Pulses, dt: float) -> None:
        """Turn both wheels towards what their pulses ask for."""
        left, right = (
            self._spin(servo, pulse_us, speed, dt)
            for servo, speed in zip(self._servos, self.wheel_speeds, strict=True)
        )
        self.wheel_speeds = left, right
        self.speed, self.yaw_rate = (left + right) / 2, (right - left) / self._mixer.track

    def halt(self) -> None:
        """Stand, both wheels with it."""
        super().halt()
        self.wheel_speeds = (0.0, 0.0)

    def _spin(self, servo: Servo, pulse_us: Pulses, speed: float, dt: float) -> float:
        throttle = self._settings.throttle(servo, pulse_us.get(servo.channel))
        return self._settings.spin(speed, throttle * self._mixer.max_speed, dt)
