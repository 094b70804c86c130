from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.control.motion.pose import Pose2D, heading_of, pose_of
from zteleop.messages import Odometry, Quaternion

SPAN = st.floats(-10, 10)
POSES = st.builds(Pose2D, SPAN, SPAN, st.floats(-3.14, 3.14))


@given(POSES, SPAN, SPAN)
def test_what_lies_ahead_and_to_the_left_is_where_it_leads(pose: Pose2D, ahead: float, left: float) -> None:
    there = pose.ahead(ahead, left)
    assert pose.local(there.x, there.y) == pytest.approx((ahead, left), abs=1e-9)
    assert pose.distance(there.x, there.y) == pytest.approx((ahead**2 + left**2) ** 0.5, abs=1e-9)


def test_left_is_positive() -> None:
    assert Pose2D(1.0, 0.0, pi / 2).local(0.0, 0.0) == pytest.approx((0.0, 1.0))
    assert Pose2D().roll(pi / 2, pi / 2) == pytest.approx((1.0, 1.0, pi / 2))
    assert Pose2D().roll(pi / 2, -pi / 2) == pytest.approx((1.0, -1.0, -pi / 2))
    assert Pose2D().roll(-1.0, 0.0) == pytest.approx((-1.0, 0.0, 0.0))


@given(POSES, st.floats(-3, 3), st.floats(-6, 6))
def test_an_arc_is_the_same_in_one_step_and_in_many(pose: Pose2D, way: float, turned: float) -> None:
    small = pose
    for _ in range(50):
        small = small.roll(way / 50, turned / 50)
    whole = pose.roll(way, turned)
    assert small[:2] == pytest.approx(whole[:2], abs=1e-9)
    assert abs(abs(small.heading - whole.heading) % (2 * pi)) == pytest.approx(0, abs=1e-9) or abs(
        small.heading - whole.heading
    ) == pytest.approx(2 * pi, abs=1e-9)


@given(POSES)
def test_it_is_said_as_ros_says_it(pose: Pose2D) -> None:
    odometry = Odometry.zero()
    odometry.pose.pose = pose.message()
    assert pose_of(odometry) == pytest.approx(pose, abs=1e-9)


def test_a_robot_that_leans_looks_where_it_looks() -> None:
    half = 0.5**0.5
    assert heading_of(Quaternion(0.0, 0.0, half, half)) == pytest.approx(pi / 2)
    assert heading_of(Quaternion(0.0, 0.0, -half, half)) == pytest.approx(-pi / 2)
    assert heading_of(Quaternion(0.1, 0.0, 0.0, 0.995)) == pytest.approx(0.0)
