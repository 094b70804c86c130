"""A simulated robot and its operator, started as users start them: processes, a pseudo-terminal, a chip."""

import fcntl
import os
import pty
import random
import select
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Self

from processes import free_endpoint, running

from zteleop.drivers.registers import LED0_ON_L
from zteleop.drivers.simulated import open_registers

ZTELEOP = str(Path(sys.executable).with_name("zteleop"))
RAW_LINE = str(Path(__file__).with_name("raw_line.py"))
ROBOT = "bench"
UP, LEFT, RIGHT = b"\x1b[A", b"\x1b[D", b"\x1b[C"
LOOK_EVERY = 20e-6
LONGEST = 0.5


class Robot:
    """An actuator with a chip in a folder of its own, so that no other robot on this machine takes part."""

    def __init__(self) -> None:
        self.folder = tempfile.mkdtemp(prefix="zteleop-bench-")
        self.endpoint = free_endpoint()
        self.chip = f"{self.folder}/zteleop/{ROBOT}.pca9685"
        self.environment = os.environ | {
            **dict.fromkeys(("XDG_RUNTIME_DIR", "XDG_CONFIG_HOME", "XDG_STATE_HOME"), self.folder),
            **{"TERM": "xterm-256color", "LC_ALL": "C.UTF-8"},
        }
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        self._stack.callback(shutil.rmtree, self.folder, ignore_errors=True)
        try:
            self.registers = self._stack.enter_context(open_registers(self.chip))
            self.actuator = self.start_actuator()
            self._await_actuator()
        except BaseException:
            self._stack.close()
            raise
        return self

    def start_actuator(self) -> "subprocess.Popen[str]":
        return self.start("actuator", "--listen", self.endpoint)

    def __exit__(self, *exc: object) -> None:
        self._stack.close()

    def start(self, verb: str, *arguments: str, **options: object) -> "subprocess.Popen[str]":
        """Start a verb for this robot, as long as the robot's `with` lasts."""
        return self.start_program(self.command(verb, *arguments), **options)

    def command(self, verb: str, *arguments: str) -> list[str]:
        """Return a verb for this robot as it is typed."""
        return [ZTELEOP, verb, "--robot", ROBOT, "--no-multicast-scouting", *arguments]

    def start_program(self, command: Sequence[str], **options: object) -> "subprocess.Popen[str]":
        """Start any program, as long as the robot's `with` lasts."""
        placed = {"env": self.environment, "cwd": self.folder} | options
        return self._stack.enter_context(running(command, **placed))

    def outputs(self) -> bytes:
        """Return the registers of channels 0 and 1, throttle and steering."""
        return self.registers.snapshot()[LED0_ON_L : LED0_ON_L + 8]

    def _await_actuator(self) -> None:
        asleep, give_up = self.outputs(), time.monotonic() + 10
        while self.outputs() == asleep:
            if self.actuator.poll() is not None or time.monotonic() > give_up:
                raise SystemExit(f"the actuator did not start: {' '.join(map(str, self.actuator.args))}")
            time.sleep(0.01)
        time.sleep(0.3)


class RawRobot(Robot):
    """A wheel at the end of raw zenoh: the peer."""

    def start_actuator(self) -> "subprocess.Popen[str]":
        return self.start_program([sys.executable, RAW_LINE, "wheel", self.endpoint, self.chip])


class Operator:
    """A keyboard node in a pseudo-terminal of its own, whose screen somebody else reads."""

    def __init__(self, robot: Robot, command: Sequence[str] | None = None) -> None:
        self._robot, self.missed = robot, 0
        self._master, slave = pty.openpty()
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 30, 100, 0, 0))
        options: Mapping[str, object] = {"stdin": slave, "stdout": slave, "start_new_session": True}
        self.process = (
            robot.start_program(command, **options)
            if command
            else robot.start("keyboard", "--drive", "step", "--connect", robot.endpoint, **options)
        )
        select.select([self._master], [], [], 5)  # until it shows something
        robot.start_program(["cat"], stdin=self._master)
        os.close(slave)
        time.sleep(1.0)
        if self.process.poll() is not None:
            raise SystemExit(f"it ended at once: {' '.join(map(str, self.process.args))}")
        Path("/proc/self/timerslack_ns").write_text("1")

    def type(self, key: bytes) -> None:
        """Send a key, whatever comes of it."""
        os.write(self._master, key)

    def press(self, key: bytes) -> float | None:
        """Press a key; return the seconds until the chip changed, None when it did not."""
        before, pressed = self._robot.outputs(), time.perf_counter()
        self.type(key)
        while self._robot.outputs() == before:
            if time.perf_counter() - pressed > LONGEST:
                return None
            time.sleep(LOOK_EVERY)  # to poll without a pause would take one of two cores
        return time.perf_counter() - pressed

    def steer(self, presses: int) -> Iterator[float]:
        """Steer left and right, some ten times a second; yield the milliseconds each took."""
        for index in range(presses):
            seconds = self.press(RIGHT if index % 2 else LEFT)
            if seconds is None:
                self.missed += 1
            else:
                yield 1000 * seconds
            time.sleep(0.1 + random.uniform(-0.03, 0.03))
