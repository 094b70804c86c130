"""Vehicles by the names that people type."""

import msgspec
import pytest

from zteleop.control.mixer import Ackermann, Differential
from zteleop.control.settings import DriveSettings
from zteleop.control.vehicles import VEHICLES, made_into, name_of
from zteleop.errors import ConfigError

OWN = msgspec.structs.replace(DriveSettings(), mixer=Ackermann(wheelbase=0.5))


@pytest.mark.parametrize("name", VEHICLES)
def test_whoever_has_no_settings_drives_what_is_built_in(name: str) -> None:
    made = made_into(DriveSettings(), name)
    assert name_of(made) == name
    assert set(made.servos) == made.mixer.wheels
    assert made_into(made, name) == made


def test_the_rest_of_the_settings_stays() -> None:
    sources = {"nav": DriveSettings().known_sources["program"]}
    made = made_into(DriveSettings(sources=sources), "tank")
    assert made.mixer == Differential()
    assert made.sources == sources


def test_somebodys_own_of_that_kind_are_kept() -> None:
    assert made_into(OWN, "car") == OWN


def test_somebodys_own_are_made_into_no_other_kind() -> None:
    with pytest.raises(ConfigError, match="makes this robot a car, so it is no tank; leave out tank"):
        made_into(OWN, "tank")
