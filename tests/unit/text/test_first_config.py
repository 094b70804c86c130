"""A first config file: what was answered, and nothing that the next verb would refuse."""

import pytest

from zteleop import config
from zteleop.control.settings import DriveSettings
from zteleop.control.vehicles import made_into, name_of
from zteleop.text.first_config import Answers, first_config


@pytest.mark.parametrize("driver", ["simulated", "pca9685"])
@pytest.mark.parametrize("vehicle", ["car", "tank"])
def test_it_says_what_was_answered(vehicle: str, driver: str) -> None:
    made = config.parse(first_config(Answers("archangel", vehicle, driver, (5, 9), 0.31)).encode())
    assert (made.robot, made.driver, name_of(made.drive)) == ("archangel", driver, vehicle)
    first, second = made.drive.servos.values()
    assert (first.channel, second.channel) == (5, 9)
    mixer = made.drive.mixer
    assert (mixer.wheelbase if vehicle == "car" else getattr(mixer, "track", 0.0)) == 0.31


@pytest.mark.parametrize(("vehicle", "length"), [("car", 0.25), ("tank", 0.2)])
def test_the_usual_answers_make_what_is_built_in(vehicle: str, length: float) -> None:
    made = config.parse(first_config(Answers("a", vehicle, "simulated", (0, 1), length)).encode())
    assert made.drive == made_into(DriveSettings(), vehicle)
