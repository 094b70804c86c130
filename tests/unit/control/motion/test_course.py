from math import pi, tau

import pytest

from zteleop.control.motion.course import COAST, Laps, Steady
from zteleop.control.motion.pose import Pose2D
from zteleop.messages import Twist

TWIST = Twist.planar(0.24, 0.48)


def test_it_goes_on_for_so_long_from_the_first_look() -> None:
    course = Steady(TWIST, 2.0)
    assert course.twist(Pose2D(), 100.0) == TWIST
    assert course.twist(Pose2D(), 101.99) == TWIST
    assert course.twist(Pose2D(), 102.0) is None


def test_without_an_end_it_goes_on() -> None:
    course = Steady(TWIST, None)
    assert course.twist(Pose2D(), 100.0) == course.twist(Pose2D(), 1e9) == TWIST


@pytest.mark.parametrize("laps", [0.5, 1.0, 2.5])
@pytest.mark.parametrize("side", [1, -1])
def test_it_goes_round_so_often(laps: float, side: int) -> None:
    course, twist = Laps(Twist.planar(0.24, side * 0.48), laps), Twist.planar(0.24, side * 0.48)
    pose, turned = Pose2D(0.0, 0.0, 3.0), 0.0
    while course.twist(pose, 0.0) == twist:
        pose = pose.roll(0.24 * 0.05, side * 0.48 * 0.05)
        turned += 0.48 * 0.05
        assert turned < 10 * tau
    assert turned == pytest.approx(laps * tau - COAST * 0.48, abs=0.48 * 0.05)


def test_turning_there_and_back_is_no_lap() -> None:
    course = Laps(TWIST, 1.0)
    for heading in [0.0, 2.0, 0.0, 2.0, 0.0, 2.0, 0.0, pi - 0.1]:
        assert course.twist(Pose2D(0.0, 0.0, heading), 0.0) == TWIST
