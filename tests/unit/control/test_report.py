import pytest
from unit.control.robot import FORWARD, TICK_US, Robot

from zteleop.control.drive import Step
from zteleop.control.limiter import Limits
from zteleop.control.mixer import Differential
from zteleop.control.report import status, to_vehicle
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.messages import DriveStatus, Pwm, Twist


def told(robot: Robot, step: Step) -> DriveStatus:
    return status(robot.drive, step, robot.chip(step), robot.now)


def test_status_tells_who_what_and_why() -> None:
    robot = Robot()
    step = robot.hold(Twist.planar(0.5, 0.5), 1.0)
    said = told(robot, step)
    assert (said.state, said.source, said.operator, said.written) == ("driving", "keyboard", "1", robot.now)
    assert (said.seq, said.refused, said.clamped) == (20, 0, 0)
    assert said.wanted == Twist.planar(0.5, 0.5)
    assert said.applied.linear.x == pytest.approx(0.5)
    assert said.applied.angular.z == pytest.approx(0.5)
    assert [pulse.name for pulse in said.pulses] == ["throttle", "steering"]


def test_at_rest_nobody_is_told_of() -> None:
    robot = Robot()
    said = told(robot, robot.step())
    assert (said.state, said.source, said.operator, said.seq, said.stops) == ("idle", "", "", 0, [])
    assert said.wanted == said.applied == Twist.planar()


def test_ticks_are_told_as_the_twist_they_ask_for() -> None:
    robot = Robot()
    said = told(robot, robot.hold(Pwm(375, 500), 1.2))
    assert said.wanted.linear.x == pytest.approx(3.0, abs=0.05)


def test_status_tells_how_fast_it_may_be_and_why_no_faster() -> None:
    robot = Robot()
    robot.wait(1.0)
    said = told(robot, robot.step())
    assert (said.max_speed, said.latency, said.slowed) == (3.0, 0.0, "")
    said = told(robot, robot.hold(FORWARD, 1.0, age=0.06))
    assert (said.max_speed, said.latency, said.slowed) == (3.0, pytest.approx(0.06), "")
    said = told(robot, robot.hold(FORWARD, 6.0, age=0.24))
    assert (said.max_speed, said.latency) == (pytest.approx(2.5), pytest.approx(0.24))
    assert said.slowed == "commands of keyboard are up to 240 ms old"


def test_status_names_the_stop_in_force_so_that_it_can_be_released() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    robot.stop(41)
    robot.stop(42)
    said = told(robot, robot.step())
    assert (said.state, [stop.id for stop in said.stops]) == ("stopped", [42])
    assert robot.release(42)
    assert told(robot, robot.step()).stops == []


def test_a_vehicle_is_described_within_its_limits() -> None:
    car = to_vehicle(DriveSettings(limits=Limits(speed=1.0, turn=2.0)), TICK_US, ready=False)
    assert (car.kind, car.max_speed, car.max_turn, car.ready) == ("ackermann", 1.0, 2.0, False)
    assert [(c.name, c.neutral_ticks) for c in car.channels] == [("throttle", 370), ("steering", 375)]
    servos = {"left": Servo(channel=0), "right": Servo(channel=1)}
    tank = to_vehicle(DriveSettings(mixer=Differential(), servos=servos), TICK_US)
    assert (tank.kind, tank.max_turn, tank.ready) == ("differential", pytest.approx(10.0), True)
