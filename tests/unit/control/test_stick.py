import pytest

from zteleop.control import curvature
from zteleop.control.mixer import Ackermann, Differential
from zteleop.control.report import to_vehicle
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.control.stick import Speeds, Stick, tightest, to_pwm, to_twist
from zteleop.messages import Pwm

CAR = to_vehicle(DriveSettings(), 4.08)
TANK = to_vehicle(
    DriveSettings(mixer=Differential(), servos={"left": Servo(channel=0), "right": Servo(channel=1)}), 4.08
)


def test_without_a_deadman_nobody_drives() -> None:
    assert to_twist(Stick(1, 1), Speeds(), CAR) is None
    assert to_pwm(Stick(1, 1), CAR) is None


def test_the_turn_of_a_car_is_curvature_at_any_speed() -> None:
    for forward in (-1.0, 0.0, 0.1, 1.0):
        twist = to_twist(Stick(forward, 0.5, True), Speeds(forward=2.0), CAR)
        assert curvature.of(twist.linear.x, twist.angular.z) == pytest.approx(0.5 * tightest(CAR))


def test_the_turn_of_a_tank_is_its_yaw_rate() -> None:
    twist = to_twist(Stick(0.0, -0.5, True), Speeds(turn=2.0), TANK)
    assert (twist.linear.x, twist.angular.z) == (0.0, -1.0)


def test_speeds_stay_within_the_vehicle() -> None:
    twist = to_twist(Stick(1.0, 1.0, True), Speeds(forward=50, turn=50), TANK)
    assert (twist.linear.x, twist.angular.z) == (TANK.max_speed, TANK.max_turn)


@pytest.mark.parametrize(
    ("stick", "pwm"),
    [
        (Stick(0, 0, True), Pwm(375, 370)),
        (Stick(1, 1, True), Pwm(460, 500)),
        (Stick(-1, -1, True), Pwm(290, 220)),
        (Stick(0, 15 / 85, True), Pwm(390, 370)),
    ],
)
def test_full_stick_is_the_end_of_the_calibration(stick: Stick, pwm: Pwm) -> None:
    assert to_pwm(stick, CAR) == pwm


def test_the_tightest_curve_is_the_bicycles() -> None:
    assert tightest(CAR) == pytest.approx(Ackermann().max_turn / Ackermann().max_speed)
