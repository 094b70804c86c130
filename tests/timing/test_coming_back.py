"""A robot that stood still for a moment drives on; one that stood still for long waits to be begun anew."""

import os
import signal
import time

import pytest
from rig import NEUTRAL, Process, Rig, Watch, every, hear, readme_program, repeating, until
from verdict import Deadline, excusable

from zteleop.bus.node import Node
from zteleop.messages import DriveStatus, Stop, Twist
from zteleop.nodes.actuator import UNHEARD

MOMENT = 0.28
"""s: longer than a step may be late, shorter than what nobody may outlive"""
LONG = 0.7
DEAF_WHILE = """
import sys
from pathlib import Path
from zteleop.cli import main
from zteleop.nodes.overhear import Overhearing
hears = Overhearing.hears
Overhearing.hears = lambda *arguments: hears(*arguments) and not Path("deaf").exists()
sys.exit(main(["actuator", *sys.argv[1:]]))
"""
"""A robot whose watchdog does not hear it on the bus for as long as a file exists."""
TOLD = 1.0
"""s from the first command that is refused until its program knows"""


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
        robot.says(
            "it stood still for a moment, and its actuator was started again; "
            "whoever drove goes on with the next act"
        )
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
    robot.says("is refused: it was moving before the robot was ready")
    for _ in every(0.005, 200):
        assert rig.ticks == NEUTRAL


def test_after_a_long_one_it_waits_and_says_why(rig: Rig, robot: Process) -> None:
    hold_up(robot, LONG)
    robot.says("let go first")
    until(lambda: rig.ticks == NEUTRAL, "neutral")
    for _ in every(0.005, 200):
        assert rig.ticks == NEUTRAL


def test_readmes_program_drives_on_after_a_stall_and_deafness_and_is_told_of_a_restart(rig: Rig) -> None:
    rig.robot = f"coming-back-{os.getpid()}"  # others may be on this network, which is everybody's default
    robot = rig.program(DEAF_WHILE, "--robot", rig.robot)
    robot.says("obeys")
    program = rig.program(readme_program(rig.robot))
    until(lambda: moves(rig), "motion")
    with excusable(0.1, rig), Watch(rig) as watch, Node("looker-on", rig.robot) as node:
        hold_up(robot, MOMENT)
        robot.says("whoever drove goes on with the next act")
        until(lambda: moves(rig), "motion after a stall")
        statuses = node.subscription("drive_status", DriveStatus)
        (rig.folder / "deaf").touch()
        hear(statuses, lambda status: UNHEARD in status.why, "a robot that is deaf to itself")
        (rig.folder / "deaf").unlink()
        until(lambda: moves(rig), "motion after deafness")
        assert NEUTRAL in watch.seen
    assert "let go first" not in robot.text + program.text
    assert robot.child
    os.kill(robot.child, signal.SIGKILL)
    program.says(f"cmd_vel is refused by robot {rig.robot}: it was moving before the robot was ready")
    for _ in every(0.005, 200):
        assert rig.ticks == NEUTRAL


def test_whoever_is_refused_knows_within_a_second(rig: Rig) -> None:
    rig.actuator()
    node = rig.node()
    motors, stops = node.publisher("cmd_vel", Twist), node.publisher("stop", Stop)
    until(lambda: stops.matched, "somebody who hears stops")
    with repeating(lambda: motors.publish(Twist.planar(0.3)), 0.1):
        until(lambda: moves(rig), "motion")
        deadline = Deadline(rig)
        stops.publish(Stop(True, 7, "ann", ""))
        deadline.met(lambda: motors.refused, "the refusal at the sender's own end", TOLD)
    assert "stopped by ann" in motors.refused
