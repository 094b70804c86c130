"""The vehicles that are built in, by the names that people type."""

from typing import NamedTuple

import msgspec

from zteleop.control import create3
from zteleop.control.limiter import Limits
from zteleop.control.mixer import Ackermann, Differential, Mixer
from zteleop.control.servo import Servo
from zteleop.control.settings import DONKEYCAR, DriveSettings
from zteleop.errors import ConfigError


class Built(NamedTuple):
    mixer: Mixer
    servos: dict[str, Servo]
    limits: Limits = Limits()


WHEELS = {"left": Servo(0), "right": Servo(1)}
CREATE3 = Limits(turn=create3.MAX_TURN, acceleration=create3.ACCELERATION)
VEHICLES = {
    "car": Built(Ackermann(), DONKEYCAR),
    "tank": Built(Differential(), WHEELS),
    "create3": Built(Differential(create3.TRACK, create3.SAFE_SPEED), WHEELS, CREATE3),
    "create3_full": Built(Differential(create3.TRACK, create3.FULL_SPEED), WHEELS, CREATE3),
}


def name_of(drive: DriveSettings) -> str:
    """Return what a vehicle is called: the one that is built so, else the first of its kind."""
    same = [name for name, built in VEHICLES.items() if built.mixer == drive.mixer]
    return (same or [name for name, built in VEHICLES.items() if built.mixer.kind == drive.mixer.kind])[0]


def made_into(drive: DriveSettings, name: str) -> DriveSettings:
    """Return the settings of a vehicle by its name: those given where they are one, else as built in.

    Bounds that somebody has set are kept. Raises ConfigError where the settings are another vehicle's.
    """
    if name_of(drive) == name:
        return drive
    if (drive.mixer, drive.servos) != VEHICLES["car"][:2]:
        own = f"[drive.mixer] and [drive.servos] make this robot a {name_of(drive)}"
        raise ConfigError(f"{own}, and no {name}; leave one out")
    built = VEHICLES[name]
    usual = msgspec.structs.asdict(Limits())
    limits = msgspec.structs.asdict(drive.limits)
    own_limits = {field: value for field, value in limits.items() if value != usual[field]}
    return msgspec.structs.replace(
        drive,
        mixer=built.mixer,
        servos=built.servos.copy(),
        limits=msgspec.structs.replace(built.limits, **own_limits),
    )
