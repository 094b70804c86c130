from math import pi

import pytest
from unit.control.lockstep import CAR, TANK, Robot

from zteleop.control.motion import pace
from zteleop.control.motion.pose import Pose2D
from zteleop.control.motion.way import Leg, Way, square
from zteleop.control.settings import DriveSettings
from zteleop.messages import Twist

START = Pose2D(1.0, -2.0, 2.5)


@pytest.mark.parametrize("radius", [0.0, 0.7])
@pytest.mark.parametrize("to_right", [False, True])
def test_a_square_ends_where_it_began(radius: float, to_right: bool) -> None:
    legs = square(START, 1.0, radius, to_right)
    assert legs[-1].end == pytest.approx(START)
    side = -1 if to_right else 1
    assert legs[2].start.heading == pytest.approx((START.heading + side * pi / 2 + pi) % (2 * pi) - pi)


def test_a_place_beside_an_arc_lies_as_far_along_it() -> None:
    for bend in (2.0, -2.0):
        leg = Leg(START, pi / 4, bend)
        for part in (0.0, 0.3, 0.99):
            at = leg.at(part * leg.length)
            for left in (-0.1, 0.0, 0.1):
                assert leg.along(at.ahead(0.0, left)) == pytest.approx(part * leg.length, abs=1e-9)
        assert leg.along(START.ahead(-0.1)) < 0


def driven(settings: DriveSettings, to_right: bool = False, aside: float = 0.0) -> tuple[Robot, Pose2D]:
    robot = Robot(settings, START.ahead(0.0, aside))
    least, speed = pace.least_radius(robot.vehicle), pace.straight_speed(robot.vehicle)
    legs = square(START, 1.0, 1.2 * least, to_right)
    most = 1 / least if least else 3.0
    robot.drive(Way(legs, speed, pace.turn_speed(robot.vehicle), most).twist)
    return robot, START


@pytest.mark.parametrize("settings", [CAR, TANK], ids=["car", "tank"])
@pytest.mark.parametrize("to_right", [False, True])
def test_a_square_closes(settings: DriveSettings, to_right: bool) -> None:
    robot, start = driven(settings, to_right)
    assert start.distance(robot.pose.x, robot.pose.y) < 0.06
    assert abs(robot.pose.heading - start.heading) < 0.15


def test_a_tank_goes_to_each_corner() -> None:
    robot, start = driven(TANK)
    for corner in ((1.0, 0.0), (1.0, 1.0), (0.0, 1.0)):
        place = start.ahead(*corner)
        assert min(place.distance(pose.x, pose.y) for pose in robot.trail) < 0.05


def test_who_starts_beside_the_way_comes_back_to_it() -> None:
    robot, start = driven(CAR, aside=0.2)
    assert start.distance(robot.pose.x, robot.pose.y) < 0.06


def test_a_line_that_was_left_is_found_again() -> None:
    robot = Robot(CAR, Pose2D(0.0, 0.2, 0.0))
    robot.drive(Way([Leg(Pose2D(), 3.0)], 0.5, 1.0, 1.5).twist)
    assert robot.pose.y == pytest.approx(0.0, abs=0.03)
    assert robot.pose.heading == pytest.approx(0.0, abs=0.05)


def test_it_slows_down_before_a_turn_on_the_spot_and_not_before_an_arc() -> None:
    line = Leg(Pose2D(), 1.0)
    for after, share in ((Leg(line.end, 0.0, 0.0, 1.0), 0.4), (Leg(line.end, 1.0, 1.0), 1.0)):
        twist = Way([line, after], 0.5, 1.0, 3.0).twist(Pose2D(0.92, 0.0, 0.0), 0.0)
        assert twist
        assert twist.linear.x == pytest.approx(share * 0.5, rel=0.25)


def test_it_stands_at_the_end() -> None:
    way = Way([Leg(Pose2D(), 1.0)], 0.5, 1.0, 3.0)
    assert way.twist(Pose2D(0.5, 0.0, 0.0), 0.0) == Twist.planar(0.5, 0.0)
    assert way.twist(Pose2D(1.0, 0.0, 0.0), 0.0) is None
    assert way.twist(Pose2D(0.5, 0.0, 0.0), 0.0) is None
