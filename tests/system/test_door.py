"""A robot whose door breaks while somebody drives: it stands, opens another, and is driven on."""

import os
import re
import signal
import socket
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from faults.deaf import is_deaf
from faults.usage import usage
from rig import NEUTRAL, Process, Rig, repeating, until

from zteleop.chaos.spoiler import poison
from zteleop.messages import Twist

LISTENS_AND_TAKES_NOBODY = """import socket, sys
if 'door' in sys.orig_argv: deaf = socket.create_server(('127.0.0.1', 0))"""
DRIVER = """from zteleop import BusSettings, Node, Twist
with Node("driver", "bench", BusSettings(connect=[{endpoint!r}], multicast=False)) as node:
    motors = node.publisher("cmd_vel", Twist)

    @node.every(0.02)
    def drive():
        if "was moving before" in motors.refused:
            motors.let_go()
        motors.publish(Twist.planar(0.5))

    node.spin()
"""
NEVER_OPENS = "import sys\nif 'door' in sys.orig_argv: raise SystemExit('no door')"


class Robot:
    """A robot that a program drives; its stream goes on whatever happens."""

    def __init__(self, rig: Rig) -> None:
        self.rig, self.process = rig, rig.actuator()
        until(lambda: self.process.recorder, "a black box")
        self.others = self.process.child, self.process.recorder
        node = rig.node("driver")
        rig.hear(node)
        self.motors = node.publisher("cmd_vel", Twist)

    @property
    def drives(self) -> bool:
        return self.rig.ticks[1] > NEUTRAL[1]

    def drives_on(self) -> bool:
        """Say whether it is driven again; where it took long, whoever drove begins anew.

        How long it may take is judged in tests/timing/test_faults.py.
        """
        if "was moving before" in self.motors.refused:
            self.motors.let_go()
        return self.drives

    @property
    def door(self) -> int:
        until(lambda: self.process.door, "a door")
        return self.process.door or 0


@pytest.fixture
def robot(rig: Rig, tmp_path: Path) -> Iterator[Robot]:
    rig.environment["PYTHONPATH"] = str(tmp_path)
    robot = Robot(rig)
    with repeating(lambda: robot.motors.publish(Twist.planar(0.5)), 0.02):
        until(lambda: robot.drives, "the throttle above neutral")
        yield robot


def killed(robot: Robot) -> None:
    os.kill(robot.door, signal.SIGKILL)


def frozen(robot: Robot) -> None:
    os.kill(robot.door, signal.SIGSTOP)


@pytest.mark.parametrize("breaks", [killed, frozen])
def test_a_robot_whose_door_breaks_opens_another_and_is_driven_on(
    robot: Robot, breaks: Callable[[Robot], None]
) -> None:
    breaks(robot)
    robot.process.says("the door to the bus is shut")
    robot.process.says("the door is open again")
    until(robot.drives_on, "whoever drove drives on")
    serves_as_before(robot.rig, robot.process, robot.others)


def serves_as_before(rig: Rig, process: Process, others: tuple[int | None, int | None]) -> None:
    assert not is_deaf(rig.port), "a newcomer is heard"
    assert (process.child, process.recorder) == others
    stopped = rig.result("stop", *rig.bus_options())
    assert (stopped.returncode, rig.ticks) == (0, NEUTRAL), stopped.stderr


def test_a_robot_whose_door_is_poisoned_opens_another_and_is_driven_by_whoever_begins_then(rig: Rig) -> None:
    """A door may pass the poison on to the drivers there are, and zenoh in their processes breaks as it does.

    So this one is a process of its own, and is started again, as people do, where that has happened: any
    other drives on.
    """
    process = rig.actuator()
    until(lambda: process.recorder, "a black box")
    others, driver = (process.child, process.recorder), Driver(rig)
    until(driver.drives, "somebody drives")
    poison(rig.endpoint)
    process.says("the door to the bus is shut")
    process.says("the door is open again")
    until(driver.drives, "a driver, perhaps a new one")
    serves_as_before(rig, process, others)


class Driver:
    """A program that drives, and another one where the first no longer does."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self._begin()

    def _begin(self) -> None:
        self._program = self._rig.program(DRIVER.format(endpoint=self._rig.endpoint))

    def drives(self) -> bool:
        """Say whether it drives; where zenoh has broken in it, as it says, try the next one."""
        moves = self._rig.ticks[1] > NEUTRAL[1]
        if not moves and "PoisonError" in self._program.text:
            self._program.signal(signal.SIGKILL)
            self._program.ends()
            self._begin()
        return moves


def test_a_robot_whose_door_never_opens_again_rests_and_is_stopped_without_one(
    robot: Robot, tmp_path: Path
) -> None:
    (tmp_path / "sitecustomize.py").write_text(NEVER_OPENS)
    killed(robot)
    until(lambda: robot.rig.ticks == NEUTRAL, "nobody is heard, so nobody drives")
    robot.process.says("another opens in 0.2 s, and nobody drives meanwhile")
    stopped = robot.rig.result("stop", "bench", "--no-multicast-scouting", "--connect", robot.rig.endpoint)
    alone = "bench answered by datagram; on the bus it is not heard\n"
    assert (stopped.returncode, stopped.stderr) == (0, alone)
    assert stopped.stdout.startswith("bench is stopped (neutral read back from the chip within ")
    (tmp_path / "sitecustomize.py").unlink()
    robot.process.says("the door is open again")
    release = robot.rig.result("stop", "--release", "--all", *robot.rig.bus_options())
    assert release.returncode == 0, release.stderr


def test_a_door_that_takes_nobody_in_any_more_is_followed_by_one_that_does(
    robot: Robot, tmp_path: Path
) -> None:
    """Its place to connect to is stuck, and nothing else is: whoever is in already drives on until then."""
    (tmp_path / "sitecustomize.py").write_text(LISTENS_AND_TAKES_NOBODY)
    killed(robot)
    robot.process.says("the door is open again")
    until(robot.drives_on, "whoever drove drives on")
    (tmp_path / "sitecustomize.py").unlink()
    robot.process.says("door: error: it takes nobody in who connects; this door ends")
    until(lambda: robot.process.text.count("the door is open again") == 2, "another door")
    until(robot.drives_on, "whoever drove drives on")


def test_a_door_that_cannot_open_ends_the_robot_in_its_own_words(rig: Rig) -> None:
    with socket.create_server(("127.0.0.1", rig.port)):
        run = rig.result("actuator", "--robot", "bench", "--no-multicast-scouting", "--listen", rig.endpoint)
    assert run.returncode == 1
    assert re.fullmatch(
        r"zteleop actuator: cannot listen at \S+: already in use by another process; .+\n", run.stderr
    ), run.stderr


CROWD = """
import json, sys, zenoh
config = zenoh.Config()
for name, value in [("mode", "client"), ("connect/endpoints", [sys.argv[1]])]:
    config.insert_json5(name, json.dumps(value))
sessions = [zenoh.open(config) for _ in range(100)]
"""
KEPT_MB = 2.5
"""from the first crowd to the third: 4 to 7 where what the one leaves is not used for the next, else 0.5"""


def test_what_a_crowd_leaves_of_memory_is_used_for_the_next(rig: Rig) -> None:
    actuator = rig.actuator()
    sizes = []
    for _ in range(3):
        assert rig.program(CROWD, rig.endpoint).ends() == 0
        until(lambda: len(os.listdir(f"/proc/{actuator.door}/fd")) < 40, "sessions that are gone")
        sizes.append(usage(actuator.process.pid)["door"].mb)
    assert sizes[-1] - sizes[0] < KEPT_MB, sizes
