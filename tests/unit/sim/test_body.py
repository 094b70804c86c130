from math import cos, inf, nan, pi, sin

import pytest

from zteleop.messages import Time
from zteleop.sim.body import Body, Pulses
from zteleop.sim.noise import LEVELS


class Rolling(Body):
    """Moves as it is told at once, and counts how often it is asked."""

    def __init__(self, speed: float = 1.0, yaw_rate: float = 0.0) -> None:
        super().__init__()
        self.speed, self.yaw_rate = speed, yaw_rate
        self.steps: list[float] = []

    def move(self, pulse_us: Pulses, dt: float) -> None:
        self.steps.append(dt)


@pytest.mark.parametrize("dt", [0.0, -1.0, -inf, nan])
def test_without_time_nothing_moves(dt: float) -> None:
    body = Rolling()
    body.step({}, dt)
    assert (body.steps, body.x, body.distance) == ([], 0.0, 0.0)


@pytest.mark.parametrize("dt", [0.001, 0.02, 0.025, 0.7])
def test_a_step_is_cut_into_short_ones_that_add_up(dt: float) -> None:
    body = Rolling()
    body.step({}, dt)
    assert max(body.steps) <= 0.01
    assert sum(body.steps) == pytest.approx(dt)
    assert body.x == pytest.approx(dt)


@pytest.mark.parametrize("dt", [1.5, 1e9, inf])
def test_a_huge_step_is_a_second(dt: float) -> None:
    body = Rolling()
    body.step({}, dt)
    assert sum(body.steps) == pytest.approx(1.0)


def test_positive_yaw_turns_left_around_a_circle_of_speed_by_yaw() -> None:
    body = Rolling(speed=1.0, yaw_rate=0.5)
    for _ in range(100):
        body.step({}, pi / 100)
    assert (body.x, body.y) == pytest.approx((2.0, 2.0), abs=1e-4)
    assert body.heading == pytest.approx(pi / 2)


def test_heading_stays_within_half_a_turn() -> None:
    body = Rolling(speed=0.0, yaw_rate=1.0)
    for _ in range(4):
        body.step({}, 1.0)
    assert body.heading == pytest.approx(4.0 - 2 * pi)


def test_distance_counts_back_and_forth() -> None:
    body = Rolling()
    body.step({}, 0.5)
    body.speed = -1.0
    body.step({}, 0.5)
    assert body.x == pytest.approx(0.0)
    assert body.distance == pytest.approx(1.0)


def test_wheels_that_err_say_another_place_than_it_is_at_and_how_wrong_that_may_be() -> None:
    body = Rolling(speed=0.5, yaw_rate=0.2)
    body.step({}, 1.0)
    assert body.odometer.pose == pytest.approx(body.pose), "without noise they do not"
    body.odometer.noise = LEVELS["high"]
    body.step({}, 1.0)
    assert body.odometer.pose != pytest.approx(body.pose, abs=1e-4)
    assert body.odometry(Time(3, 4)).pose.covariance[0] > 0


def test_odometry_says_pose_and_twist_as_ros_does() -> None:
    body = Rolling(speed=0.5, yaw_rate=0.2)
    body.odometer.x, body.odometer.y, body.odometer.heading = 1.0, 2.0, 2.0
    odometry = body.odometry(Time(3, 4))
    assert (odometry.header.frame_id, odometry.child_frame_id) == ("odom", "base_link")
    assert odometry.header.stamp == Time(3, 4)
    assert (odometry.pose.pose.position.x, odometry.pose.pose.position.y) == (1.0, 2.0)
    turned = odometry.pose.pose.orientation
    assert (turned.x, turned.y, turned.z, turned.w) == (0.0, 0.0, sin(1.0), cos(1.0))
    assert (odometry.twist.twist.linear.x, odometry.twist.twist.angular.z) == (0.5, 0.2)
    assert len(odometry.pose.covariance) == len(odometry.twist.covariance) == 36
