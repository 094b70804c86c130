"""Does a stranger on the network end driving, or keep a stop out? Each attack begins under a drive."""

import subprocess
import sys
import time
from contextlib import suppress
from types import SimpleNamespace
from typing import NamedTuple

from figures import command_line, median, print_table
from idle_cost import parts_of, private_mb
from processes import running
from robot import ROBOT, Robot

from zteleop.chaos.stranger import ATTACKS
from zteleop.drivers.registers import read_duty_ticks

NEUTRAL_THROTTLE, THROTTLE = 370, 0
LASTS, AFTER = 8.0, 2.0
"""s of an attack, and s after its end in which it must be driven again"""
STOP_AT = (0.3, 4.0)
"""s into an attack at which somebody stops the robot from a fresh process"""
PROCESSES, STEADY_MB = 4, 0.2
"""of a robot that has started, and what it still takes in a second then"""
LOOK = 0.002
PATIENCE = 30.0
DRIVE = "{linear: {x: 0.5}}"


class Driven(NamedTuple):
    """How it was driven on during an attack, and came back afterwards."""

    share: float
    again: float | None
    """s after its end; None when it was not, in time"""
    grown_mb: float
    ended: int
    """processes of the robot that are others now"""


class Stopped(NamedTuple):
    """What a stop from a fresh process came to."""

    code: int
    rested: float | None
    """s from its start until the chip was neutral; None when it was not"""


def moves(robot: Robot) -> bool:
    return read_duty_ticks(robot.registers.snapshot(), THROTTLE) not in (None, NEUTRAL_THROTTLE)


def until(robot: Robot, wanted: bool, seconds: float) -> float | None:
    """Wait until it moves, or rests; return after how long."""
    began = time.monotonic()
    while moves(robot) is not wanted:
        if time.monotonic() - began > seconds:
            return None
        time.sleep(LOOK)
    return time.monotonic() - began


def strike(robot: Robot, attack: str) -> "subprocess.Popen[str]":
    """Begin an attack; it lasts as long as the robot's `with`, or until it is killed."""
    process = robot.start_program(
        [sys.executable, "-m", "zteleop.chaos.stranger", attack, robot.endpoint, ROBOT],
        stdout=subprocess.PIPE,
    )
    assert process.stdout
    process.stdout.readline()
    return process


def processes(robot: Robot) -> list[int]:
    with suppress(OSError):
        return [part.pid for part in parts_of(robot.actuator).values()]
    return [robot.actuator.pid]


def memory_mb(robot: Robot) -> float:
    total = 0.0
    for pid in processes(robot):
        with suppress(OSError):
            total += private_mb(SimpleNamespace(pid=pid))
    return total


def driving(robot: Robot) -> None:
    """Let a program drive it 20 times a second, whatever happens, and wait until all of it has started."""
    robot.start("pub", "cmd_vel", "Twist", DRIVE, "-r", "20", "--connect", robot.endpoint)
    if until(robot, True, PATIENCE) is None:
        raise SystemExit("nobody can drive this robot")
    give_up = time.monotonic() + PATIENCE
    before, after = 0.0, memory_mb(robot)
    while len(processes(robot)) < PROCESSES or after - before > STEADY_MB:
        if time.monotonic() > give_up:
            raise SystemExit("this robot does not come to rest")
        time.sleep(1.0)
        before, after = after, memory_mb(robot)


def drive_through(attack: str) -> Driven:
    """Drive while an attack lasts, and see whether that goes on."""
    with Robot() as robot:
        driving(robot)
        before, theirs = memory_mb(robot), processes(robot)
        attacker, moved, looks = strike(robot, attack), 0, 0
        end = time.monotonic() + LASTS
        while time.monotonic() < end:
            moved, looks = moved + moves(robot), looks + 1
            time.sleep(LOOK)
        grown = memory_mb(robot) - before
        attacker.kill()
        again = until(robot, True, AFTER)
        return Driven(moved / looks, again, grown, len(set(theirs) - set(processes(robot))))


def stop_during(attack: str, when: float) -> Stopped:
    """Stop it from a fresh process some time into an attack."""
    with Robot() as robot:
        driving(robot)
        strike(robot, attack)
        time.sleep(when)
        command = robot.command("stop", "--connect", robot.endpoint)
        with running(command, env=robot.environment, cwd=robot.folder) as stop:
            rested = until(robot, False, PATIENCE)
            with suppress(subprocess.TimeoutExpired):
                stop.wait(PATIENCE)
            return Stopped(-1 if stop.returncode is None else stop.returncode, rested)


def main() -> None:
    parser = command_line(__doc__ or "")
    parser.add_argument("--times", metavar="N", type=int, default=5)
    parser.add_argument("--only", metavar="TEXT", default="", help="the attacks whose name holds this")
    arguments = parser.parse_args()
    times = 1 if arguments.quick else arguments.times
    rows = []
    for attack in [name for name in ATTACKS if arguments.only in name]:
        drives = [drive_through(attack) for _ in range(times)]
        stops = [stop_during(attack, when) for when in STOP_AT for _ in range(times)]
        again = [driven.again for driven in drives]
        rests = [stopped.rested for stopped in stops]
        rows.append(
            (
                attack,
                f"{100 * median([driven.share for driven in drives]):.0f} %",
                "never" if None in again else f"{max(filter(None, [*again, 1e-3])):.2f} s",
                f"{max(driven.grown_mb for driven in drives):+.0f} MB",
                max(driven.ended for driven in drives),
                "never" if None in rests else f"{max(filter(None, [*rests, 1e-3])):.2f} s",
                f"{sum(stopped.code == 0 for stopped in stops)} of {len(stops)}",
            )
        )
    head = ["what a stranger does", "driven", "again", "memory", "ended", "stop: at rest", "exit code 0"]
    print_table(
        f"driven for {LASTS:g} s of each, and stopped from a fresh process, {times} times", head, rows
    )


if __name__ == "__main__":
    main()
