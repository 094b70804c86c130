"""Two driven wheels, each with its own speed controller; base_link between them."""

from collections.abc import Mapping

from zteleop.control.mixer import Differential
from zteleop.control.servo import Servo
from zteleop.sim.body import Body, Disc, Pulses
from zteleop.sim.esc import Esc, EscSettings

RADIUS = 0.6
"""of the track"""


class Tank(Body):
    def __init__(
        self, mixer: Differential, servos: Mapping[str, Servo], settings: EscSettings | None = None
    ) -> None:
        super().__init__()
        self._mixer = mixer
        self.discs = (Disc(0.0, RADIUS * mixer.track),)
        settings = settings or EscSettings()
        self._escs = Esc(settings), Esc(settings)
        self._servos = servos["left"], servos["right"]
        self.wheel_speeds = (0.0, 0.0)
        """m/s, left and right."""

    def move(self, pulse_us: Pulses, dt: float) -> None:
        """Turn both wheels towards what their pulses ask for."""
        most = self._mixer.max_speed * self.power
        left, right = (
            esc.drive(speed, servo, pulse_us.get(servo.channel), most, dt)
            for esc, servo, speed in zip(self._escs, self._servos, self.wheel_speeds, strict=True)
        )
        self.wheel_speeds = left, right
        self.speed, self.yaw_rate = (left + right) / 2, (right - left) / self._mixer.track

    def halt(self) -> None:
        """Stand, both wheels with it."""
        super().halt()
        self.wheel_speeds = (0.0, 0.0)
