"""Thirty simulated robots on one machine: do they keep real time, and what do they cost together?"""

import os
import re
import subprocess
import tempfile
import time
from contextlib import ExitStack
from pathlib import Path
from typing import NamedTuple

from figures import command_line, median, print_table, verdict
from idle_cost import cpu_seconds
from processes import running
from robot import ZTELEOP

from zteleop.drivers import open_driver

ROBOTS = 30
NEUTRAL, CIRCLE = {0: 1509.6, 1: 1530.0}, {0: 1620.0, 1: 1600.0}
"""us, as an actuator leaves them on the chip"""
SETTLED = 5.0
"""s in which each gets as fast as it will"""
LATE = 0.05
"""by how much a second of a robot may be shorter than a second"""
MOVES = re.compile(r"^ *([0-9.]+) m/s .* rolled ([0-9.]+) m$", re.MULTILINE)


def main() -> None:
    parser = command_line(__doc__)
    parser.add_argument("--robots", type=int, default=ROBOTS, help=f"default: {ROBOTS}")
    options = parser.parse_args()
    seconds, cores = 5.0 if options.quick else 30.0, os.cpu_count() or 1
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="zteleop-classroom-")))
        robots = [folder / f"robot-{number}" for number in range(options.robots)]
        processes = [start(stack, robot) for robot in robots]
        while not all(moves(robot).way for robot in robots):
            time.sleep(0.1)
        time.sleep(SETTLED)
        before, spent, began = list(map(moves, robots)), sum(map(cpu_seconds, processes)), time.monotonic()
        time.sleep(seconds)
        after, spent = list(map(moves, robots)), sum(map(cpu_seconds, processes)) - spent
        taken = time.monotonic() - began
    kept = [(there.way - here.way) / (there.speed * taken) for here, there in zip(before, after, strict=True)]
    less, share = 1 - min(kept), 100 * spent / taken
    print_table(
        f"{options.robots} simulated cars that drive circles, {cores} cores",
        ("what", "median", "worst", "target"),
        [
            ("way of a second, of what it should be", median(kept), min(kept), verdict(less, LATE, "less")),
            ("all of them, % of a core", share, "", verdict(share, 100.0 * cores, "%")),
        ],
    )


class Moved(NamedTuple):
    """What a simulator said last."""

    speed: float
    """m/s"""
    way: float
    """m since the start"""


def start(stack: ExitStack, robot: Path) -> "subprocess.Popen[str]":
    """Start a simulator on a chip of its own, on which somebody has left pulses."""
    robot.mkdir()
    chip = {"path": str(robot / "chip")}
    driver = open_driver("simulated", chip)
    driver.start(NEUTRAL)
    driver.write(CIRCLE)
    driver.close()
    (robot / "config.toml").write_text(f'[drivers.simulated]\npath = "{chip["path"]}"\n')
    says = stack.enter_context((robot / "says").open("w"))
    where = ["--config", str(robot / "config.toml"), "--robot", robot.name, "--no-multicast-scouting"]
    command = [ZTELEOP, "sim", "car", *where, "--listen", "tcp/127.0.0.1:0"]
    return stack.enter_context(running(command, stdout=says))


def moves(robot: Path) -> Moved:
    """Return how it moves; not at all before it says so."""
    found = MOVES.findall((robot / "says").read_text())
    return Moved(*map(float, found[-1])) if found else Moved(0.0, 0.0)


if __name__ == "__main__":
    main()
