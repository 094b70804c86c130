import argparse
from typing import Any

import pytest

from zteleop.cli import actuator
from zteleop.config import Config
from zteleop.control.mixer import Differential
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.errors import ConfigError

TANK = DriveSettings(mixer=Differential(), servos={"left": Servo(channel=0), "right": Servo(channel=1)})


def tuned(drive: DriveSettings | None = None, **typed: Any) -> DriveSettings:
    arguments = argparse.Namespace(**{"pulse_duty": None, "neutral_offset": 0} | typed)
    return actuator._tuned(Config(drive=drive or DriveSettings()), arguments, 4.0)


def test_nothing_typed_changes_nothing() -> None:
    assert tuned() == DriveSettings()
    assert tuned(TANK) == TANK


def test_the_pulse_duty_typed_is_obeyed() -> None:
    assert tuned(pulse_duty=0.8).limits.pulse_duty == 0.8


def test_an_offset_shifts_the_throttles_neutral_by_ticks() -> None:
    servos = tuned(neutral_offset=-3).servos
    assert servos["throttle"].neutral_us == pytest.approx(1509.6 - 12.0)
    assert servos["steering"] == DriveSettings().servos["steering"]


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        ({"pulse_duty": 0.0}, r"Expected `float` > 0\.0"),
        ({"pulse_duty": 1.1}, r"Expected `float` <= 1\.0"),
        ({"pulse_duty": float("nan")}, "Expected `float` > 0.0"),
        ({"neutral_offset": 200}, "neutral_us must lie between min_us and max_us"),
        ({"neutral_offset": -(10**6)}, "Expected `float` >= 500.0"),
        ({"neutral_offset": 10**400}, "int too large"),
    ],
)
def test_what_cannot_be_obeyed_is_refused(typed: dict[str, Any], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        tuned(**typed)


def test_a_vehicle_without_a_throttle_has_no_neutral_to_shift() -> None:
    with pytest.raises(ConfigError, match="throttle"):
        tuned(TANK, neutral_offset=3)
