from math import tan

import msgspec
import pytest

from zteleop.control.mixer import Differential
from zteleop.control.motion import pace
from zteleop.control.report import to_vehicle
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.messages import Twist, Vehicle

MIXER = Differential(track=0.2, max_speed=0.4)
TANK = to_vehicle(
    DriveSettings(mixer=MIXER, servos={"left": Servo(channel=0), "right": Servo(channel=1)}), 4.08
)
CAR = to_vehicle(DriveSettings(), 4.08)


def test_a_car_has_a_least_radius_and_others_turn_on_the_spot() -> None:
    assert pace.least_radius(CAR) == pytest.approx(0.25 / tan(0.4))
    assert pace.least_radius(TANK) == 0.0


@pytest.mark.parametrize("radius", [0.05, 0.2, 0.5, 1.0, 10.0])
def test_a_tank_goes_round_a_circle_without_being_scaled(radius: float) -> None:
    speed = pace.circle_speed(TANK, radius)
    wheels = MIXER.mix(Twist.planar(speed, speed / radius))
    assert MIXER.unmix(wheels).linear.x == pytest.approx(speed)
    assert 0.9 < max(wheels.values()) <= 1.0 or speed == pace.EASY


def test_nobody_has_to_run_after_a_car() -> None:
    assert CAR.max_speed == 3.0
    assert pace.circle_speed(CAR, 1.0) == pace.straight_speed(CAR) == pace.EASY


@pytest.mark.parametrize("vehicle", [CAR, TANK], ids=["car", "tank"])
def test_there_is_room_to_correct(vehicle: Vehicle) -> None:
    assert 0 < pace.straight_speed(vehicle) <= 0.8 * vehicle.max_speed
    assert 0 < pace.turn_speed(vehicle) <= 0.8 * vehicle.max_turn


def test_a_snail_goes_as_fast_as_it_can() -> None:
    snail = msgspec.structs.replace(TANK, max_speed=0.01)
    assert pace.straight_speed(snail) == pytest.approx(0.008)
