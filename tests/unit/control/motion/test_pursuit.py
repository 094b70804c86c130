import pytest
from unit.control.lockstep import CAR, TANK, Robot

from zteleop.control.motion.pace import least_radius
from zteleop.control.motion.pose import Pose2D
from zteleop.control.motion.pursuit import Pursuit
from zteleop.control.settings import DriveSettings
from zteleop.messages import Twist

WITHIN = 0.1
KINDS = pytest.mark.parametrize(("kind", "speed"), [(CAR, 0.5), (TANK, 0.3)], ids=["car", "tank"])


def pursuit(kind: DriveSettings, x: float, y: float, speed: float = 0.5) -> tuple[Robot, Pursuit]:
    robot = Robot(kind)
    return robot, Pursuit(robot.vehicle, x, y, speed, WITHIN)


@pytest.mark.parametrize("side", [1, -1])
def test_a_place_within_its_turning_circle_makes_a_car_loop_round(side: int) -> None:
    robot, course = pursuit(CAR, 0.0, side * 0.6)
    first = course.twist(robot.pose)
    assert course.makes_room
    assert first == Twist.planar(first.linear.x if first else 0.0)
    robot.drive(course.twist)
    assert max(abs(pose.x) for pose in robot.trail) > least_radius(robot.vehicle)


def test_a_car_is_never_asked_to_turn_more_tightly_than_it_can() -> None:
    near = Pursuit(Robot(CAR).vehicle, 0.095, 0.05, 0.5, WITHIN).twist(Pose2D())
    assert near
    assert near.angular.z == pytest.approx(near.linear.x / least_radius(Robot(CAR).vehicle))
    robot, course = pursuit(CAR, -1.0, 0.3)
    least = least_radius(robot.vehicle)
    while twist := course.twist(robot.pose):
        assert twist.linear.x > 0
        assert abs(twist.angular.z) * least <= twist.linear.x + 1e-9
        robot.obey(twist)


def test_a_fast_car_slows_down_in_a_bend() -> None:
    straight, bend = (pursuit(CAR, 3.0, y, 3.0)[1].twist(Pose2D()) for y in (0.0, 3.0))
    assert straight
    assert bend
    assert straight.linear.x == 3.0
    assert bend.linear.x * bend.angular.z == pytest.approx(2.0)


def test_who_can_turns_on_the_spot_first() -> None:
    robot, course = pursuit(TANK, -1.0, 0.1)
    twist = course.twist(robot.pose)
    assert twist
    assert twist.linear.x == 0.0
    assert twist.angular.z > 0


@KINDS
def test_it_slows_down_near_the_place_and_ends_there(kind: DriveSettings, speed: float) -> None:
    _, course = pursuit(kind, 3.0, 0.0, speed)
    far, near = course.twist(Pose2D(0.0, 0.0, 0.0)), course.twist(Pose2D(2.8, 0.0, 0.0))
    assert far
    assert near
    assert far.linear.x == pytest.approx(speed)
    assert 0 < near.linear.x < 0.7 * speed
    assert course.twist(Pose2D(2.95, 0.0, 0.0)) is None
