from math import pi

import pytest
from hypothesis import given
from hypothesis import strategies as st
from unit.control.lockstep import CAR, PERIOD, TANK, Robot

from zteleop.control.motion.dead_reckoning import HEADING, DeadReckoning, OdometrySettings, X
from zteleop.control.motion.pose import heading_of
from zteleop.control.settings import DriveSettings
from zteleop.messages import Time, Twist

NO_LAG = OdometrySettings(motor_lag=0.0)
NOW = Time(1, 2)
TICKS = OdometrySettings(ticks_per_metre=1000.0, track=0.2)


@pytest.mark.parametrize("settings", [CAR, TANK], ids=["car", "tank"])
def test_it_says_where_a_vehicle_is_that_does_what_it_is_told(settings: DriveSettings) -> None:
    robot, reckoning = Robot(settings), DeadReckoning(OdometrySettings(), steers=settings is CAR)
    for twist, times in ((Twist.planar(0.5, 0.3), 60), (Twist.planar(0.4, -0.2), 40), (Twist.zero(), 20)):
        for _ in range(times):
            robot.obey(twist)
            reckoning.obey(twist, PERIOD)
    assert reckoning.distance == pytest.approx(robot.body.distance, rel=0.05)
    assert reckoning.pose.distance(robot.pose.x, robot.pose.y) < 0.1 * reckoning.distance
    assert reckoning.speed == pytest.approx(0.0, abs=0.01)


def test_a_circle_comes_back() -> None:
    reckoning = DeadReckoning(NO_LAG, steers=True)
    for _ in range(400):
        reckoning.obey(Twist.planar(0.5, pi / 10), 0.05)
    assert reckoning.pose == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    assert reckoning.distance == pytest.approx(10.0)


def test_what_was_measured_scales_the_way_and_not_the_bend() -> None:
    reckoning = DeadReckoning(OdometrySettings(motor_lag=0.0, scale=0.5), steers=True)
    for _ in range(20):
        reckoning.obey(Twist.planar(1.0, 1.0), 0.05)
    assert reckoning.distance == pytest.approx(0.5)
    assert reckoning.pose.heading == pytest.approx(0.5)


def test_a_car_that_stands_turns_its_wheels_alone() -> None:
    reckoning = DeadReckoning(NO_LAG, steers=True)
    reckoning.obey(Twist.planar(0.0, 1.0), 0.1)
    assert reckoning.pose == (0.0, 0.0, 0.0)
    spins = DeadReckoning(NO_LAG, steers=False)
    spins.obey(Twist.planar(0.0, 1.0), 0.1)
    assert spins.pose.heading == pytest.approx(0.1)


def test_encoders_say_way_and_turn() -> None:
    reckoning = DeadReckoning(TICKS, steers=False)
    reckoning.count(5000, 7000, 0.0)  # what they had counted before
    reckoning.count(5500, 7500, 0.5)
    assert reckoning.pose == pytest.approx((0.5, 0.0, 0.0))
    assert (reckoning.speed, reckoning.yaw_rate) == pytest.approx((1.0, 0.0))
    reckoning.count(5450, 7550, 0.5)
    assert reckoning.pose == pytest.approx((0.5, 0.0, 0.5))
    assert (reckoning.speed, reckoning.yaw_rate) == pytest.approx((0.0, 1.0))


def test_encoders_that_begin_anew_move_nothing() -> None:
    reckoning = DeadReckoning(TICKS, steers=False)
    for ticks in (100_000, 0, 2**31 - 1, -(2**31)):
        reckoning.count(ticks, ticks, 0.05)
    assert reckoning.pose == (0.0, 0.0, 0.0)
    reckoning.count(-(2**31) + 100, -(2**31) + 100, 0.05)
    assert reckoning.pose.x == pytest.approx(0.1)


def test_an_imu_gives_the_heading_and_the_wheels_the_way() -> None:
    reckoning = DeadReckoning(NO_LAG, steers=True)
    reckoning.look(2.0)
    reckoning.obey(Twist.planar(1.0, 3.0), 0.1)
    assert reckoning.pose == pytest.approx((0.1, 0.0, 0.0))  # its wheels slipped
    reckoning.look(2.0 + pi / 2)
    reckoning.obey(Twist.planar(0.0, 0.0), 0.1)
    assert reckoning.pose.heading == pytest.approx(pi / 2)


def test_without_its_imu_it_goes_on_by_its_wheels_from_there() -> None:
    reckoning = DeadReckoning(NO_LAG, steers=False)
    reckoning.look(1.0)
    reckoning.look(1.5)
    reckoning.obey(Twist.zero(), 0.1)
    reckoning.forget_compass()
    reckoning.obey(Twist.planar(0.0, 1.0), 0.1)
    assert reckoning.pose.heading == pytest.approx(0.6)
    reckoning.look(-2.0)  # another north
    reckoning.obey(Twist.zero(), 0.1)
    assert reckoning.pose.heading == pytest.approx(0.6)


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-2, 2)), min_size=1, max_size=30))
def test_it_is_never_sure_and_ever_less(told: list[tuple[float, float]]) -> None:
    reckoning = DeadReckoning(NO_LAG, steers=False)
    before = (0.0, 0.0)
    for speed, turn in told:
        reckoning.obey(Twist.planar(speed, turn), 0.1)
        covariance = reckoning.odometry(NOW).pose.covariance
        now = (covariance[X], covariance[HEADING])
        assert now[0] > 0 < now[1]
        assert now[0] >= before[0]
        assert now[1] >= before[1]
        before = now


def test_it_is_said_as_ros_says_it() -> None:
    reckoning = DeadReckoning(NO_LAG, steers=False)
    reckoning.obey(Twist.planar(1.0, 0.0), 0.5)
    reckoning.obey(Twist.planar(0.5, 1.0), 0.5)
    odometry, frame = reckoning.odometry(NOW), reckoning.transform(NOW)
    assert (odometry.header.frame_id, odometry.child_frame_id) == ("odom", "base_link")
    assert (frame.header.frame_id, frame.child_frame_id) == ("odom", "base_link")
    assert odometry.header.stamp == frame.header.stamp == NOW
    assert odometry.twist.twist == Twist.planar(0.5, 1.0)
    place = odometry.pose.pose.position
    assert (frame.transform.translation.x, frame.transform.translation.y) == (place.x, place.y)
    assert heading_of(frame.transform.rotation) == pytest.approx(0.5)
