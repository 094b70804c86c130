"""Where a robot should be: by what it is told, by encoders, by an IMU, and by which of them that speaks."""

from math import pi
from types import SimpleNamespace

import pytest

from zteleop.bus.topics import TOPICS
from zteleop.control.motion.dead_reckoning import OdometrySettings
from zteleop.control.motion.pose import Pose2D, pose_of, turned_by
from zteleop.control.report import to_vehicle
from zteleop.control.settings import DriveSettings
from zteleop.messages import (
    Header,
    Imu,
    Odometry,
    Quaternion,
    TFMessage,
    Time,
    Twist,
    Vector3,
    WheelTicks,
)
from zteleop.nodes.dead_reckoner import ENCODERS_SILENT, HEARD_WITHIN, SILENT, DeadReckoner
from zteleop.testing import FakeNode

PERIOD = TOPICS["odom"].every
TOLD, TICKS, COMPASS = (
    "what its wheels are told",
    "the encoders of its wheels",
    ", and the heading of its IMU",
)
HEADER, NO_VECTOR = Header(Time(1, 0), "imu"), Vector3(0.0, 0.0, 0.0)
ZEROS = [0.0] * 9
GONE, NOBODY = "robot archangel is not heard", "no actuator is heard here"


def imu(turned: Quaternion, covariance: list[float] = ZEROS) -> Imu:
    return Imu(HEADER, turned, covariance, NO_VECTOR, ZEROS, NO_VECTOR, ZEROS)


class Reckoned:
    def __init__(self, node: FakeNode, settings: OdometrySettings) -> None:
        self.node = node
        self.told: list[str] = []
        node.hear_beat(vehicle=to_vehicle(DriveSettings(), 4.08))
        self.reckoner = DeadReckoner(node, settings, self.told.append)  # type: ignore[arg-type]

    def drive(self, linear: float, angular: float, seconds: float) -> None:
        """Let it hear that it is driven so; with nothing, that nobody says so."""
        for _ in range(round(seconds / PERIOD)):
            status = SimpleNamespace(applied=Twist.planar(linear, angular))
            self.node.hear("drive_status", status)  # type: ignore[arg-type]
            self.step()

    def stand(self, seconds: float = PERIOD) -> None:
        """Let it hear that it stands."""
        self.drive(0.0, 0.0, seconds)

    def step(self, times: int = 1) -> None:
        for _ in range(times):
            self.node.loop.clock.pass_by(PERIOD)
            self.node.loop.run(PERIOD)

    def turn(self, heading: float) -> None:
        self.node.hear("imu", imu(turned_by(heading)))

    def count(self, left: int, right: int) -> None:
        self.node.hear("wheel_ticks", WheelTicks(HEADER, left, right))

    @property
    def odom(self) -> Odometry:
        odom = self.node.said["odom"].messages[-1]
        assert isinstance(odom, Odometry)
        return odom

    @property
    def moving(self) -> tuple[float, float]:
        twist = self.odom.twist.twist
        return twist.linear.x, twist.angular.z

    @property
    def pose(self) -> Pose2D:
        return pose_of(self.odom)


@pytest.fixture
def robot(node: FakeNode) -> Reckoned:
    return Reckoned(node, OdometrySettings(motor_lag=0.0, ticks_per_metre=1000.0, track=0.2))


def test_it_counts_what_the_wheels_are_told(robot: Reckoned) -> None:
    robot.drive(0.5, 0.0, 2.0)
    assert robot.pose == pytest.approx((1.0, 0.0, 0.0))
    robot.drive(0.5, 0.5, 1.0)
    assert robot.pose.heading == pytest.approx(0.5)
    assert robot.moving == pytest.approx((0.5, 0.5))
    assert robot.told == [TOLD]


def test_a_car_that_stands_does_not_turn(robot: Reckoned) -> None:
    robot.drive(0.0, 1.0, 1.0)
    assert robot.pose == (0.0, 0.0, 0.0)


def test_an_estimate_is_marked_as_one_that_drifts(robot: Reckoned) -> None:
    robot.stand()
    first = robot.odom.pose.covariance[0]
    robot.drive(0.5, 0.0, 2.0)
    assert 0.0 < first < robot.odom.pose.covariance[0]


def test_of_a_robot_that_is_not_heard_nobody_says_where_it_is_and_that_is_told(robot: Reckoned) -> None:
    robot.drive(0.5, 0.0, 1.0)
    robot.step(round(SILENT / PERIOD) + 1)
    before, said = robot.pose, robot.node.said["odom"].messages
    count = len(said)
    robot.step(20)
    assert len(said) == count
    assert robot.node.warnings == [f"{GONE} any more, and where it is not said; {NOBODY}"]
    robot.stand()
    assert robot.node.infos == ["robot archangel is heard"]
    assert robot.pose == before
    assert robot.odom.twist.twist == Twist.zero()


def test_who_waits_for_a_robot_that_was_never_there_is_told_after_a_second(robot: Reckoned) -> None:
    robot.step(round(HEARD_WITHIN / PERIOD))
    assert robot.node.warnings == []
    robot.step(10)
    assert robot.node.warnings == [f"{GONE}, and where it is not said; {NOBODY}"]
    assert robot.node.said["odom"].messages == []


def test_encoders_count_while_they_speak(robot: Reckoned) -> None:
    robot.count(7000, 7000)
    robot.step()
    for number in range(1, 11):
        robot.count(7000 + 10 * number, 7000 + 30 * number)
        robot.drive(9.0, 0.0, PERIOD)
    assert robot.pose.heading == pytest.approx(1.0)
    assert robot.moving == pytest.approx((0.02 / PERIOD, 0.1 / PERIOD))
    robot.step(round(ENCODERS_SILENT / PERIOD) + 1)
    robot.stand()
    assert robot.told == [TICKS, TOLD]
    x = robot.pose.x
    robot.count(8000, 8000)
    robot.step()
    assert robot.pose.x == x, "what was counted in the silence is not known to be way"


def test_encoders_that_speak_seldom_are_not_taken_for_fast(robot: Reckoned) -> None:
    for number in range(6):
        robot.count(100 * number, 100 * number)
        robot.step(round(1.0 / PERIOD))
    assert robot.pose.x == pytest.approx(0.5), "once a second is often enough"
    assert robot.odom.twist.twist.linear.x == pytest.approx(0.1)
    assert robot.told[-1] == TICKS


def test_encoders_count_for_nothing_where_the_settings_say_so(node: FakeNode) -> None:
    robot = Reckoned(node, OdometrySettings(wheels="told", motor_lag=0.0))
    robot.count(0, 0)
    robot.step()
    robot.count(5000, 5000)
    robot.drive(0.5, 0.0, 1.0)
    assert robot.pose.x == pytest.approx(0.5)
    assert robot.told == [TOLD]


def test_an_imu_says_the_heading_while_it_speaks(robot: Reckoned) -> None:
    robot.turn(2.0)
    robot.stand()
    assert robot.pose.heading == pytest.approx(0.0), "it counts from where it begins"
    robot.turn(2.0 + pi / 2)
    robot.drive(0.5, 0.0, PERIOD)
    assert robot.pose.heading == pytest.approx(pi / 2)
    robot.stand(SILENT + 2 * PERIOD)
    assert robot.told == [f"{TOLD}{COMPASS}", TOLD]
    robot.drive(0.5, 0.5, 1.0)
    assert robot.pose.heading == pytest.approx(pi / 2 + 0.5)


def test_an_imu_counts_for_nothing_where_the_settings_say_so(node: FakeNode) -> None:
    robot = Reckoned(node, OdometrySettings(imu=False))
    robot.turn(1.0)
    robot.stand()
    robot.turn(2.0)
    robot.stand()
    assert (robot.pose.heading, robot.told) == (0.0, [TOLD])


def test_the_pose_is_told_as_tf_too(robot: Reckoned) -> None:
    robot.drive(0.5, 0.0, 1.0)
    said = robot.node.said["tf"].messages[-1]
    assert isinstance(said, TFMessage)
    (transform,) = said.transforms
    assert (transform.header.frame_id, transform.child_frame_id) == ("odom", "base_link")
    assert transform.transform.translation.x == robot.pose.x
    assert isinstance(transform.transform.rotation, Quaternion)


@pytest.mark.parametrize(("speed", "turn"), [(1e308, 0.0), (0.0, 1e308), (1e9, 0.0), (0.0, -99.0)])
def test_what_nothing_drives_is_not_driven(robot: Reckoned, speed: float, turn: float) -> None:
    robot.drive(0.5, 0.0, 1.0)
    robot.step(round(SILENT / PERIOD) + 1)
    before = robot.pose
    robot.drive(speed, turn, 1.0)
    assert robot.pose == before
    assert robot.node.warnings[1].startswith("drive_status does not count: nothing drives at ")


@pytest.mark.parametrize("size", [0.0, 1e308, 0.5])
def test_a_rotation_that_is_none_turns_nothing(robot: Reckoned, size: float) -> None:
    for _ in range(3):
        robot.node.hear("imu", imu(Quaternion(0.0, 0.0, size, size)))
        robot.drive(0.5, 0.5, PERIOD)
    assert robot.pose.heading == pytest.approx(3 * 0.5 * PERIOD)
    assert robot.told == [TOLD]
    assert robot.node.warnings[0].startswith("imu does not count: a rotation has a length of 1, found ")


def test_an_imu_that_knows_no_orientation_turns_nothing(robot: Reckoned) -> None:
    unknown = imu(turned_by(0.0), [-1.0, *ZEROS[1:]])
    for _ in range(3):
        robot.node.hear("imu", unknown)
        robot.drive(0.5, 0.5, PERIOD)
    assert robot.pose.heading == pytest.approx(3 * 0.5 * PERIOD)
    assert robot.node.warnings[0] == "imu does not count: this imu knows no orientation"
