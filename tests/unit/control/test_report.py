from math import tan

import pytest
from unit.control.robot import FORWARD, TICK_US, Robot

from zteleop.control.drive import Step
from zteleop.control.gate import Refusal
from zteleop.control.limiter import Limits
from zteleop.control.mixer import Differential
from zteleop.control.refusals import Turned
from zteleop.control.report import overridden, refusals, status, to_vehicle
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.control.snapshot import snapshot
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


@pytest.mark.parametrize("command", [Twist.planar(0.0, 0.5), Pwm(300, 370)])
def test_a_car_that_stands_is_told_to_stand_wherever_its_front_wheels_point(command: Twist | Pwm) -> None:
    robot = Robot()
    said = told(robot, robot.hold(command, 0.3))
    assert abs(next(pulse.fraction for pulse in said.pulses if pulse.name == "steering")) > 0.1
    assert said.applied == Twist.planar()
    assert said.wanted == (command if isinstance(command, Twist) else Twist.planar())


@pytest.mark.parametrize(
    ("first", "second", "waits"), [("program", "keyboard", False), ("keyboard", "program", True)]
)
def test_who_came_after_the_last_step_waits_only_where_the_other_goes_first(
    first: str, second: str, waits: bool
) -> None:
    robot = Robot()
    step = robot.hold(FORWARD, 0.2, source=first)
    robot.say(FORWARD, "b", second)
    seen = snapshot(robot.drive, step, robot.now)
    told = {claim.source: overridden(seen, claim) for claim in seen.claims}
    assert told.pop(first) is None
    words = "keyboard 0001 drives, with priority 90 over 50; this one is obeyed when that one is done"
    assert told == {second: words if waits else None}


def test_whoever_waits_is_told_of_a_stop_and_not_of_who_drove_before() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    waits = {12: Turned("program", "keyboard 0001 drives, with priority 90 over 50", 0.0, 0.0)}
    assert refusals(robot.drive, waits, robot.now).refused[0].why.startswith("keyboard 0001 drives")
    robot.stop(41)
    assert refusals(robot.drive, waits, robot.now).refused[0].why == Refusal.AT_REST


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
    assert (car.kind, car.max_speed, car.ready) == ("ackermann", 1.0, False)
    assert car.max_turn == pytest.approx(1.0 * tan(0.4) / 0.25), "as fast as it turns at that speed"
    slow = to_vehicle(DriveSettings(limits=Limits(turn=2.0)), TICK_US)
    assert slow.max_turn == 2.0
    assert [(c.name, c.neutral_ticks) for c in car.channels] == [("throttle", 370), ("steering", 375)]
    servos = {"left": Servo(channel=0), "right": Servo(channel=1)}
    tank = to_vehicle(DriveSettings(mixer=Differential(), servos=servos), TICK_US)
    assert (tank.kind, tank.max_turn, tank.ready) == ("differential", pytest.approx(10.0), True)


@pytest.mark.parametrize(("why", "by"), [(Refusal.HELD, "keyboard 0001"), (Refusal.STALE, "")])
def test_whoever_waits_for_a_source_is_told_whose_it_is(why: Refusal, by: str) -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    waits = {11: Turned("keyboard", why, 0.0, 0.0), 12: Turned("web", why, 0.0, 0.0)}
    told = refusals(robot.drive, waits, robot.now).refused
    assert [(one.sender, one.by) for one in told] == [("b", by), ("c", "")]


@pytest.mark.parametrize("stopped", [True, False])
def test_whoever_waited_for_one_who_is_gone_is_told_what_is_so_now(stopped: bool) -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    if stopped:
        robot.stop(7)
    else:
        robot.drive.admission.mux.release(1)
    (told,) = refusals(robot.drive, {2: Turned("keyboard", Refusal.HELD, 0.0, 0.0)}, robot.now).refused
    assert (told.why, told.by) == (Refusal.AT_REST if stopped else Refusal.WAITED, "")
