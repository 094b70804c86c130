"""What the pulses move: pure physics, one file per kind of vehicle, one line below."""

from collections.abc import Callable, Mapping

from zteleop.control.mixer import Mixer
from zteleop.control.servo import Servo
from zteleop.errors import ConfigError
from zteleop.sim.body import Body
from zteleop.sim.car import Car
from zteleop.sim.tank import Tank

VEHICLES: dict[str, Callable[..., Body]] = {"ackermann": Car, "differential": Tank}


def make_vehicle(mixer: Mixer, servos: Mapping[str, Servo]) -> Body:
    """Return the vehicle that a mixer drives, standing at the origin.

    Raises ConfigError when a wheel has no servo.
    """
    if missing := sorted(mixer.wheels - servos.keys()):
        found = ", ".join(sorted(servos)) or "none"
        raise ConfigError(f"a vehicle of this kind needs servos for {', '.join(missing)}; found {found}")
    return VEHICLES[mixer.kind](mixer, servos)
