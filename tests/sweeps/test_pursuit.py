"""A place to go to, wherever it is and however the robot stands."""

from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st
from unit.control.lockstep import CAR, TANK, Robot

from zteleop.control.motion.pose import Pose2D
from zteleop.control.motion.pursuit import Pursuit
from zteleop.control.settings import DriveSettings

ANGLE = st.floats(-pi, pi)
WITHIN = 0.1


@pytest.mark.parametrize(
    ("kind", "speed"),
    [(CAR, 0.5), (CAR, 0.2), (CAR, 3.0), (TANK, 0.3), (TANK, 1.0)],
    ids=["car", "slow car", "fast car", "tank", "fast tank"],
)
@given(heading=ANGLE, bearing=ANGLE, away=st.floats(0, 5))
def test_any_place_is_reached_from_anywhere(
    kind: DriveSettings, speed: float, heading: float, bearing: float, away: float
) -> None:
    robot = Robot(kind, Pose2D(1.0, -1.0, heading))
    x, y = 1.0 + away * cos(bearing), -1.0 + away * sin(bearing)
    robot.drive(Pursuit(robot.vehicle, x, y, speed, WITHIN).twist, patience=60.0)
    assert robot.pose.distance(x, y) < WITHIN + 0.1  # it rolls on a little
