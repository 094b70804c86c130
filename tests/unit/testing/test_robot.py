"""A program drives a simulated robot in a test's time, as it would drive a real one."""

from math import pi
from typing import Any

import pytest

from zteleop import Int16MultiArray, Odometry, Pwm, Range, Twist, TwistStamped
from zteleop.control.create3 import SAFE_SPEED
from zteleop.messages import Header, MultiArrayLayout
from zteleop.sim.noise import LEVELS
from zteleop.sim.scene import Scene, Wall
from zteleop.testing import FakeNode, SimulatedRobot


def driven(
    message: Any, seconds: float, vehicle: str = "car", topic: str = "cmd_vel", **more: Any
) -> SimulatedRobot:
    """Return a robot after a program has said one thing for so long, ten times a second."""
    node = FakeNode()
    robot = SimulatedRobot(node, vehicle, **more)
    motors = node.publisher(topic, type(message))
    node.every(0.1)(lambda: motors.publish(message))
    node.live(seconds)
    return robot


def test_it_drives_where_it_is_told() -> None:
    robot = driven(Twist.planar(0.5), 4.0)
    assert robot.pose.x == pytest.approx(2.0, abs=0.3)
    assert robot.pose.y == pytest.approx(0.0, abs=0.01)
    assert robot.step.state == "driving"


@pytest.mark.parametrize(
    ("topic", "message"),
    [
        ("cmd_vel", TwistStamped(Header.zero(), Twist.planar(0.5))),
        ("pwm", Pwm(375, 392)),
        ("pwm", Int16MultiArray(MultiArrayLayout.zero(), [375, 392])),
    ],
)
def test_every_command_counts(topic: str, message: Any) -> None:
    assert driven(message, 3.0, topic=topic).pose.x > 0.5


def test_a_create_3_is_as_fast_as_the_real_one_and_turns_on_the_spot() -> None:
    robot = driven(Twist.planar(2.0), 3.0, "create3")
    assert robot.speed == pytest.approx(SAFE_SPEED, abs=0.01)
    turned = driven(Twist.planar(0.0, pi / 2), 1.2, "tank")
    assert turned.pose.heading == pytest.approx(pi / 2, abs=0.4)
    assert turned.distance < 0.1


def test_a_program_that_falls_silent_stands_after_half_a_second() -> None:
    node = FakeNode()
    robot = SimulatedRobot(node)
    motors = node.publisher("cmd_vel", Twist)
    motors.publish(Twist.planar(0.5))
    node.live(0.45)
    assert robot.step.state == "driving"
    node.live(0.2)
    assert robot.step.claim is None
    node.live(3.0)
    assert robot.speed == 0.0


def test_what_is_let_go_ends_at_once() -> None:
    node = FakeNode()
    robot = SimulatedRobot(node)
    motors = node.publisher("cmd_vel", Twist)
    motors.publish(Twist.planar(0.5))
    node.live(0.1)
    motors.let_go()
    node.live(0.1)
    assert robot.step.state == "idle"


def test_it_says_where_it_is_twenty_times_a_second_to_whoever_hears() -> None:
    node = FakeNode()
    robot = SimulatedRobot(node)
    seen: list[Odometry] = []
    node.on("odom", Odometry)(seen.append)
    node.live(1.0)
    assert 19 <= len(seen) <= 21
    motors = node.publisher("cmd_vel", Twist)
    node.every(0.1)(lambda: motors.publish(Twist.planar(0.5)))
    node.live(2.0)
    assert seen[-1].pose.pose.position.x == pytest.approx(robot.pose.x, abs=0.05)
    assert seen[-1].header.stamp.sec > seen[0].header.stamp.sec


def test_it_sees_and_runs_into_what_stands_in_its_scene() -> None:
    node = FakeNode()
    robot = SimulatedRobot(node, scene=Scene(walls=[Wall(points=[(1.5, -1.0), (1.5, 1.0)])]))
    ranges: list[Range] = []
    node.on("range", Range)(ranges.append)
    motors = node.publisher("cmd_vel", Twist)
    node.every(0.1)(lambda: motors.publish(Twist.planar(0.5)))
    assert robot.stands_at == ""
    node.live(5.0)
    assert robot.stands_at == "walls[0]"
    assert robot.speed == 0.0
    assert ranges[0].range > 1.0 > 0.1 > ranges[-1].range


def test_the_same_seed_is_the_same_drive_and_noise_is_in_what_it_says_and_not_in_where_it_is() -> None:
    def drive(seed: int) -> tuple[float, float]:
        node = FakeNode()
        robot = SimulatedRobot(node, noise=LEVELS["high"], seed=seed)
        seen: list[Odometry] = []
        node.on("odom", Odometry)(seen.append)
        motors = node.publisher("cmd_vel", Twist)
        node.every(0.1)(lambda: motors.publish(Twist.planar(1.0)))
        node.live(5.0)
        return robot.pose.x, seen[-1].pose.pose.position.x

    first, again, other = drive(1), drive(1), drive(2)
    assert first == again
    assert first[0] == other[0]
    assert first[1] != other[1]


def test_a_test_may_take_what_was_said_and_the_robot_hears_what_comes_then() -> None:
    node = FakeNode()
    robot = SimulatedRobot(node)
    motors = node.publisher("cmd_vel", Twist)
    for _ in range(20):
        motors.publish(Twist.planar(0.5))
        node.live(0.1)
        assert len(motors.take()) == 1
    assert robot.pose.x > 0.5


def test_why_it_does_not_obey_is_told_to_the_program() -> None:
    node = FakeNode()
    SimulatedRobot(node, "tank")
    motors = node.publisher("pwm", Pwm)
    node.every(0.1)(lambda: motors.publish(Pwm(375, 400)))
    node.live(0.5)
    assert motors.refused
