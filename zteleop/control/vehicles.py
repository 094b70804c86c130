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
VEHICLES = {
    "car": Built(Ackermann(), DONKEYCAR),
    "tank": Built(Differential(), WHEELS),
    "create3": Built(
        Differential(create3.TRACK, create3.SAFE_SPEED),
        WHEELS,
        Limits(turn=create3.MAX_TURN, acceleration=create3.ACCELERATION),
    ),
}


def name_of(drive: DriveSettings) -> str:
    """Return what a vehicle is called: the one that is built so, else the first of its kind."""
    same = [name for name, built in VEHICLES.items() if built.mixer == drive.mixer]
    return (same or [name for name, built in VEHICLES.items() if built.mixer.kind == drive.mixer.kind])[0]


def made_into(drive: DriveSettings, name: str) -> DriveSettings:
    """Return the settings of a vehicle by its name: those given where they are of its kind, else as built in.

    Raises ConfigError where they are somebody's own, of another kind.
    """
    built = VEHICLES[name]
    if drive.mixer.kind == built.mixer.kind:
        return drive
    if Built(drive.mixer, drive.servos, drive.limits) != VEHICLES[own := name_of(drive)]:
        raise ConfigError(f"config.toml makes this robot a {own}, so it is no {name}; leave out {name}")
    return msgspec.structs.replace(drive, mixer=built.mixer, servos=built.servos.copy(), limits=built.limits)
