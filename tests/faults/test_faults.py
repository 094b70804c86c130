"""Each fault a few times; `make faults` does it fifty times and prints a table."""

import os
import signal
import subprocess
from contextlib import suppress
from pathlib import Path

import pytest
from faults.faults import DRIVEN, FAULTS, FORWARD, STREAM, Fault, driven, measure, on_i2c
from rig import NEUTRAL, ZTELEOP, Rig, repeating, until

from zteleop.messages import Pwm

BUSY = 0.1
"""s more than the bound, which a machine that runs other tests may take"""


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: fault.name.replace(" ", "-"))
def test_a_fault_brings_neutral_in_time_and_for_good(tmp_path: Path, fault: Fault) -> None:
    with driven(tmp_path, alone=fault.alone) as bench:
        assert measure(fault, bench) <= fault.bound + BUSY


@pytest.mark.parametrize("name", ["actuator killed", "actuator frozen", "watchdog killed", "stop pressed"])
def test_the_real_driver_keeps_the_same_bounds(tmp_path: Path, name: str) -> None:
    (fault,) = (fault for fault in FAULTS if fault.name == name)
    with driven(tmp_path, alone=fault.alone, prepare=on_i2c) as bench:
        assert measure(fault, bench) <= fault.bound + BUSY


def test_a_log_that_nobody_reads_holds_up_nobody(tmp_path: Path) -> None:
    ear, mouth = os.pipe()
    os.set_blocking(mouth, False)
    with suppress(BlockingIOError):
        while True:
            os.write(mouth, b"x" * 4096)
    os.set_blocking(mouth, True)
    with Rig(tmp_path) as rig:
        command = [*ZTELEOP, "actuator", "--robot", rig.robot, "--no-multicast-scouting"]
        robot = subprocess.Popen(
            [*command, "--listen", rig.endpoint], env=rig.environment, cwd=rig.folder, stderr=mouth
        )
        try:
            node = rig.node()
            rig.hear(node)
            publisher = node.publisher("pwm", Pwm, source="keyboard")
            with repeating(lambda: publisher.publish(FORWARD), STREAM):
                until(lambda: rig.ticks == DRIVEN, "the command on the chip")
                for _ in range(3):  # each is refused, and said so
                    rig.node().publisher("pwm", Pwm, source="keyboard").publish(FORWARD)
            assert until(lambda: rig.ticks == NEUTRAL, "neutral after silence") <= 0.35 + BUSY
            robot.terminate()
            assert robot.wait(5.0) == 128 + signal.SIGTERM
        finally:
            robot.kill()
            robot.wait()
            os.close(ear)
            os.close(mouth)


@pytest.mark.parametrize("key", ["\x1a", "\x1c"], ids=["Ctrl-Z", "Ctrl-backslash"])
def test_no_key_of_its_terminal_leaves_the_wheels_turning(tmp_path: Path, key: str) -> None:
    with Rig(tmp_path) as rig:
        bus = ["--robot", rig.robot, "--no-multicast-scouting", "--listen", rig.endpoint]
        terminal = rig.terminal("actuator", *bus)
        terminal.shows("obeys")
        node = rig.node()
        rig.hear(node)
        publisher = node.publisher("pwm", Pwm, source="keyboard")
        with repeating(lambda: publisher.publish(FORWARD), STREAM):
            until(lambda: rig.ticks == DRIVEN, "the command on the chip")
            terminal.type(key)
            if key == "\x1c":
                until(lambda: rig.ticks == NEUTRAL, "neutral")
        assert until(lambda: rig.ticks == NEUTRAL, "neutral after silence") <= 0.35 + BUSY
