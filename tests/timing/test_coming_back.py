"""A robot that stood still for a moment drives on; one that stood still for long waits to be begun anew."""

import os
import signal
import time

import pytest
from rig import NEUTRAL, Process, Rig, Watch, every, until
from verdict import excusable

MOMENT = 0.28
"""s: longer than a step may be late, shorter than what nobody may outlive"""
LONG = 0.7


def moves(rig: Rig) -> bool:
    return rig.ticks[1] > NEUTRAL[1]


@pytest.fixture
def robot(rig: Rig) -> Process:
    robot = rig.actuator()
    rig.join("pub", "cmd_vel", "Twist", "{linear: {x: 0.3}}", "-r", "10")
    until(lambda: moves(rig), "motion")
    return robot


def hold_up(robot: Process, seconds: float) -> None:
    """Let all its processes stand still for a while, as on a machine that is busy with something else."""
    pids = [pid for pid in (robot.child, robot.process.pid) if pid]
    for pid in pids:
        os.kill(pid, signal.SIGSTOP)
    time.sleep(seconds)
    for pid in reversed(pids):
        os.kill(pid, signal.SIGCONT)


def test_a_program_that_goes_on_drives_on_after_a_moment(rig: Rig, robot: Process) -> None:
    with excusable(0.1, rig), Watch(rig) as watch:
        hold_up(robot, MOMENT)
        robot.says("whoever drove goes on with the next act")
        until(lambda: NEUTRAL in watch.seen, "rest, at the end of it")
        until(lambda: moves(rig), "motion")
        assert "let go first" not in robot.text


def test_a_program_drives_on_under_another_actuator_where_the_first_came_late(
    rig: Rig, robot: Process
) -> None:
    late = robot.child
    assert late
    with excusable(0.1, rig), Watch(rig) as watch:
        os.kill(late, signal.SIGSTOP)
        robot.says("the actuator is gone: it was silent for 0.2")
        robot.says("its actuator came late, and was started again; whoever drove goes on with the next act")
        assert NEUTRAL in watch.seen
        until(lambda: moves(rig), "motion")
        assert robot.child not in (None, late)


def test_a_program_drives_on_where_the_watchdog_came_late(rig: Rig, robot: Process) -> None:
    with excusable(0.1, rig), Watch(rig) as watch:
        robot.signal(signal.SIGSTOP)
        until(lambda: NEUTRAL in watch.seen, "rest, by the actuator, which then ends")
        robot.signal(signal.SIGCONT)
        robot.says("whoever drove goes on with the next act")
        until(lambda: moves(rig), "motion")


def test_one_whose_actuator_crashed_is_started_and_waits(rig: Rig, robot: Process) -> None:
    assert robot.child
    os.kill(robot.child, signal.SIGKILL)
    robot.says("is refused: it was moving before the robot started")
    for _ in every(0.005, 200):
        assert rig.ticks == NEUTRAL


def test_after_a_long_one_it_waits_and_says_why(rig: Rig, robot: Process) -> None:
    hold_up(robot, LONG)
    robot.says("let go first")
    until(lambda: rig.ticks == NEUTRAL, "neutral")
    for _ in every(0.005, 200):
        assert rig.ticks == NEUTRAL
