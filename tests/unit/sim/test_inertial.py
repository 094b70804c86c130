"""What an inertial unit feels of a body."""

from math import atan2, pi
from random import Random

import pytest

from zteleop.messages import Header, Imu, Time
from zteleop.sim.body import Body, Pulses
from zteleop.sim.inertial import GRAVITY, Inertial
from zteleop.sim.noise import LEVELS

HEADER = Header(Time(1, 0), "imu")


class Lump(Body):
    """A body that moves as it is told."""

    discs = ()

    def move(self, pulse_us: Pulses, dt: float) -> None:
        pass


def felt(body: Body, unit: Inertial, dt: float = 0.05) -> Imu:
    return unit.measure(HEADER, body, dt)


def test_at_rest_it_feels_gravity_upwards_and_nothing_else() -> None:
    imu = felt(Lump(), Inertial())
    assert (imu.linear_acceleration.x, imu.linear_acceleration.y) == (0.0, 0.0)
    assert imu.linear_acceleration.z == GRAVITY
    assert imu.angular_velocity.z == 0.0
    assert imu.header == HEADER


def test_it_feels_that_it_is_faster_than_before_and_then_no_more() -> None:
    body, unit = Lump(), Inertial()
    body.speed = 0.1
    assert felt(body, unit).linear_acceleration.x == pytest.approx(2.0)
    assert felt(body, unit).linear_acceleration.x == 0.0


def test_in_a_bend_to_the_left_it_is_pushed_to_the_left() -> None:
    body, unit = Lump(), Inertial()
    body.speed, body.yaw_rate = 2.0, 0.5
    imu = felt(body, unit)
    assert imu.linear_acceleration.y == pytest.approx(1.0)
    assert imu.angular_velocity.z == 0.5


def test_it_knows_where_it_looks_whatever_its_wheels_believe() -> None:
    body = Lump()
    body.heading, body.odometer.heading = pi / 2, 0.3
    q = felt(body, Inertial()).orientation
    assert 2 * atan2(q.z, q.w) == pytest.approx(pi / 2)


def test_chance_errors_are_as_large_as_its_covariance_says() -> None:
    body, unit = Lump(), Inertial(LEVELS["high"], Random(1))
    turns = [felt(body, unit).angular_velocity.z for _ in range(2000)]
    spread = (sum(turn**2 for turn in turns) / len(turns)) ** 0.5
    assert spread == pytest.approx(LEVELS["high"].gyro, rel=0.1)
    assert felt(body, unit).angular_velocity_covariance[8] == LEVELS["high"].gyro ** 2
