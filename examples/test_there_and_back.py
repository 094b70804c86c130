"""Tests of a program, in no time and without a robot: pytest test_there_and_back.py"""

from typing import Any

import pytest
from there_and_back import SPEED, there_and_back

from zteleop import Odometry
from zteleop.testing import FakeNode, Link, SimulatedRobot


def at(x: float) -> Odometry:
    odometry = Odometry.zero()
    odometry.pose.pose.position.x = x
    return odometry


def drive(node: Any, *places: float) -> list[float]:
    """Let the robot be at one place after the other, a tenth of a second each; return the speeds wanted."""
    there_and_back(node)
    for x in places:
        node.hear("odom", at(x))
        node.live(0.1)
    return [twist.linear.x for twist in node.said["cmd_vel"].take()]


def test_it_turns_back_after_a_metre_and_stops_at_the_start() -> None:
    node = FakeNode()
    speeds = drive(node, 5.0, 5.6, 6.1, 5.5, 5.05)
    assert speeds == [SPEED] * 3 + [-SPEED] * 2
    assert node.stopped
    assert node.said["cmd_vel"].lets_go == 1


def test_until_it_knows_where_it_is_it_drives_ahead() -> None:
    assert drive(FakeNode()) == []
    node = FakeNode()
    there_and_back(node)  # type: ignore[arg-type]
    node.live(0.35)
    assert [twist.linear.x for twist in node.said["cmd_vel"].messages] == [SPEED] * 4


@pytest.mark.parametrize("link", [Link(drop=2), Link(repeat=2), Link(swap=4)])
def test_a_bad_link_does_not_keep_it_from_turning_back(link: Link[Odometry]) -> None:
    places = [n / 10 for n in (*range(13), *range(12, -1, -1), 0)]
    node = FakeNode(link=link)
    assert min(drive(node, *places)) == -SPEED
    assert node.stopped


def test_a_simulated_robot_ends_near_where_it_began() -> None:
    node = FakeNode()
    robot = SimulatedRobot(node)
    there_and_back(node)  # type: ignore[arg-type]
    node.live(20.0)
    assert node.stopped
    assert robot.pose.x == pytest.approx(0.0, abs=0.2)
    assert robot.distance == pytest.approx(2.0, abs=0.4)
