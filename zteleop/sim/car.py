"""A car with one motor and front wheels that steer: the bicycle model, base_link on the rear axle."""

from collections.abc import Mapping
from math import tan
from typing import Annotated

from msgspec import Meta

from zteleop.control.mixer import Ackermann
from zteleop.control.servo import Servo
from zteleop.sim.body import Body, Disc, Pulses
from zteleop.sim.esc import Esc, EscSettings, fraction


class CarSettings(EscSettings, frozen=True, forbid_unknown_fields=True):
    servo_speed: Annotated[float, Meta(gt=0, le=1000)] = 6.0
    """rad/s of the front wheels."""


DISCS = ((0.2, 0.5), (0.5, 0.5), (0.8, 0.5))
"""Ahead, and radius, of the wheelbase: a body a third longer than wide, with an overhang at both ends."""


class Car(Body):
    def __init__(
        self, mixer: Ackermann, servos: Mapping[str, Servo], settings: CarSettings | None = None
    ) -> None:
        super().__init__()
        self._mixer = mixer
        self.discs = tuple(Disc(a * mixer.wheelbase, r * mixer.wheelbase) for a, r in DISCS)
        self._settings = settings or CarSettings()
        self._esc = Esc(self._settings)
        self._steering = servos["steering"]
        self._throttle = servos["throttle"]
        self.steering_angle = 0.0
        """rad of the front wheels, positive to the left."""

    def move(self, pulse_us: Pulses, dt: float) -> None:
        """Turn the front wheels and the motor towards what the pulses ask for."""
        self._steer(pulse_us.get(self._steering.channel), dt)
        pulse = pulse_us.get(self._throttle.channel)
        most = self._mixer.max_speed * self.power
        self.speed = self._esc.drive(self.speed, self._throttle, pulse, most, dt)
        self.yaw_rate = self._held(self.speed * tan(self.steering_angle) / self._mixer.wheelbase)

    def _held(self, yaw_rate: float) -> float:
        """Return how fast it turns, rad/s: in a bend that its tyres cannot hold it slides outward."""
        aside = abs(self.speed * yaw_rate)
        grip = self._settings.grip
        return yaw_rate if aside <= grip else yaw_rate * grip / aside

    def _steer(self, pulse_us: float | None, dt: float) -> None:
        wanted = fraction(self._steering, pulse_us)
        if wanted is None:  # a servo without a pulse is limp, and the wheels stay
            return
        reach = self._settings.servo_speed * dt
        error = wanted * self._mixer.max_steering_angle - self.steering_angle
        self.steering_angle += max(-reach, min(reach, error))
