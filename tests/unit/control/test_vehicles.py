"""Vehicles by the names that people type."""

import msgspec
import pytest

from zteleop.control import create3
from zteleop.control.limiter import Limits
from zteleop.control.mixer import Ackermann, Differential
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.control.vehicles import VEHICLES, made_into, name_of
from zteleop.errors import ConfigError

OWN = msgspec.structs.replace(DriveSettings(), mixer=Ackermann(wheelbase=0.5))
OWN_TANK = DriveSettings(mixer=Differential(track=0.5), servos={"left": Servo(4), "right": Servo(5)})


@pytest.mark.parametrize("name", VEHICLES)
def test_whoever_has_no_settings_drives_what_is_built_in(name: str) -> None:
    made = made_into(DriveSettings(), name)
    assert name_of(made) == name
    assert set(made.servos) == made.mixer.wheels
    assert made_into(made, name) == made


def test_the_rest_of_the_settings_stays() -> None:
    sources = {"nav": DriveSettings().known_sources["program"]}
    made = made_into(DriveSettings(sources=sources, limits=Limits(speed=0.2)), "create3")
    assert made.sources == sources
    assert made.limits == Limits(speed=0.2, turn=create3.MAX_TURN, acceleration=create3.ACCELERATION)


@pytest.mark.parametrize(("own", "name"), [(OWN, "car"), (OWN_TANK, "tank")])
def test_somebodys_own_of_that_kind_are_kept(own: DriveSettings, name: str) -> None:
    assert made_into(own, name) == own


@pytest.mark.parametrize(
    ("own", "is_a", "name"),
    [(OWN, "car", "tank"), (OWN, "car", "create3"), (OWN_TANK, "tank", "create3"), (OWN_TANK, "tank", "car")],
)
def test_somebodys_own_are_made_into_no_other(own: DriveSettings, is_a: str, name: str) -> None:
    with pytest.raises(ConfigError, match=f"make this robot a {is_a}, and no {name}; leave one out"):
        made_into(own, name)
