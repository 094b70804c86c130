"""A robot on a bench: real processes on a real bus of their own, watched at the chip's registers."""

import os
import random
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, closing, contextmanager, suppress
from pathlib import Path
from typing import Self, TypeVar

import zenoh
from processes import PATIENCE, ZTELEOP, Process, Terminal, Unmet, until, users_of

from zteleop.bus.node import Node
from zteleop.bus.settings import BusSettings
from zteleop.bus.subscription import Subscription
from zteleop.bus.zenoh_open import open_zenoh
from zteleop.drivers.registers import read_duty_ticks
from zteleop.drivers.simulated import open_registers
from zteleop.machine import realtime
from zteleop.messages import Message

M = TypeVar("M", bound=Message)
ROOT = Path(__file__).parents[1]
THROTTLE, STEERING = 0, 1
NEUTRAL = (375, 370)


PORTS = range(10_000, 30_000)
"""below those that kernels give to whoever connects: nobody takes one before it is listened on"""


def free_port() -> int:
    while True:
        port = random.choice(PORTS)
        with closing(socket.socket()) as probe, suppress(OSError):
            probe.bind(("127.0.0.1", port))
            return port


def hear(inbox: Subscription[M], wanted: Callable[[M], bool], what: str) -> M:
    """Wait for a message; an inbox itself would wait for ever."""
    found: list[M] = []

    def look() -> bool:
        found.extend(received.message for received in inbox.take() if wanted(received.message))
        return bool(found)

    until(look, what)
    return found[0]


P = TypeVar("P", bound=Process)


class Watch:
    """Looks at the chip all the time and keeps what it saw."""

    def __init__(self, rig: "Rig") -> None:
        self._rig = rig
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._look, daemon=True)
        self.seen: set[tuple[int | None, int | None]] = set()
        self.changes: list[tuple[float, tuple[int | None, int | None]]] = []
        """When the chip was first seen with other pulses, and which."""

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *exc: object) -> None:
        self._ended.set()
        self._thread.join()

    def saw_only(self, *pulses: tuple[int, int]) -> None:
        """Assert that whoever drives was never disturbed, which a machine alone can do but by neutral."""
        assert self.seen - {NEUTRAL} == set(pulses), f"expected {pulses} all the time, saw {self.changes}"
        if NEUTRAL in self.seen:
            raise Unmet(f"expected {pulses} all the time, saw {self.changes}")

    def _look(self) -> None:
        while True:
            ticks = self._rig.ticks
            self.seen.add(ticks)
            if not self.changes or self.changes[-1][1] != ticks:
                self.changes.append((time.monotonic(), ticks))
            if self._ended.wait(0.002):
                return


class Rig:
    """One robot with a simulated chip in a folder of its own, and everybody who talks to it."""

    def __init__(self, folder: Path, robot: str = "bench") -> None:
        self.folder, self.robot = folder, robot
        self.port = free_port()
        self.environment = {
            name: value for name, value in os.environ.items() if not name.startswith(("XDG_", "ZENOH"))
        } | {
            f"XDG_{kind}": str(folder / kind.lower()) for kind in ("CONFIG_HOME", "STATE_HOME", "RUNTIME_DIR")
        }
        self.chip = str(folder / "chip")
        (folder / "config.toml").write_text(f'[drivers.simulated]\npath = "{self.chip}"\n')
        self.registers = open_registers(self.chip)
        self._stack = ExitStack()
        # A watchdog that is killed leaves its folder, whose path must be short: sockets lie in it.
        place = self.environment["TMPDIR"] = self._stack.enter_context(
            tempfile.TemporaryDirectory(prefix="r")
        )
        self._stack.callback(lambda: until(lambda: not users_of(place), f"the end of {users_of(place)}"))
        self._stack.callback(self.registers.close)
        self._processes: list[Process] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        self._stack.close()

    def set(self, line: str) -> None:
        """Add a setting to the robot's config file."""
        config = self.folder / "config.toml"
        config.write_text(f"{line}\n{config.read_text()}")

    @property
    def endpoint(self) -> str:
        return f"tcp/127.0.0.1:{self.port}"

    @property
    def ticks(self) -> tuple[int | None, int | None]:
        """Steering and throttle, as they stand on the chip now."""
        seen = self.registers.snapshot()
        return read_duty_ticks(seen, STEERING), read_duty_ticks(seen, THROTTLE)

    def run(self, *arguments: str) -> Process:
        """Run a verb as it stands."""
        return self.keep(Process([*ZTELEOP, *arguments], self.environment, self.folder))

    def program(self, text: str, *arguments: str) -> Process:
        """Run somebody's Python program."""
        command = [sys.executable, "-c", text, *arguments]
        return self.keep(Process(command, self.environment, self.folder))

    def result(self, verb: str, *arguments: str) -> "subprocess.CompletedProcess[str]":
        """Run a verb to its end; its output and its errors apart."""
        return subprocess.run(
            [*ZTELEOP, verb, *arguments],
            env=self.environment,
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=PATIENCE,
        )

    def keyboard(
        self,
        *arguments: str,
        columns: int = 80,
        rows: int = 24,
        environment: Mapping[str, str] | None = None,
        tells_releases: bool = False,
    ) -> Terminal:
        """Sit down before a terminal with the keyboard's screen on it."""
        return self.terminal(
            "keyboard",
            *arguments,
            *self.bus_options(),
            columns=columns,
            rows=rows,
            environment=environment or {},
            tells_releases=tells_releases,
        )

    def terminal(
        self,
        *arguments: str,
        columns: int = 80,
        rows: int = 24,
        environment: Mapping[str, str] | None = None,
        tells_releases: bool = False,
    ) -> Terminal:
        """Run a verb in the foreground of a terminal."""
        surroundings = self.environment | {"TERM": "xterm-256color", "LC_ALL": "C.UTF-8"}
        surroundings |= environment or {}
        command = [*ZTELEOP[1:], *arguments]
        return self.keep(Terminal(command, surroundings, self.folder, columns, rows, tells_releases))

    def session(self) -> zenoh.Session:
        """Join the bus without any of zteleop's manners."""
        session = open_zenoh(BusSettings(connect=[self.endpoint], multicast=False))
        self._stack.callback(session.close)
        return session

    @property
    def pids(self) -> list[int]:
        """Every process of the robot and of who talks to it; an actuator after its watchdog."""
        found = [(process.process.pid, process.child) for process in self._processes]
        return [pid for pair in found for pid in pair if pid]

    def keep(self, process: P) -> P:
        """Let a process end with the rig."""
        self._processes.append(process)
        self._stack.callback(process.close)
        return process

    def join(self, verb: str, *arguments: str, port: int | None = None) -> Process:
        """Run a verb that talks to the actuator."""
        endpoint = f"tcp/127.0.0.1:{port or self.port}"
        return self.run(verb, *arguments, *self.bus_options(endpoint))

    def bus_options(self, endpoint: str | None = None) -> list[str]:
        return ["--robot", self.robot, "--no-multicast-scouting", "--connect", endpoint or self.endpoint]

    def actuator(self, *arguments: str) -> Process:
        """Start the actuator and wait until it obeys."""
        process = self.run(
            "actuator",
            "--robot",
            self.robot,
            "--no-multicast-scouting",
            "--listen",
            self.endpoint,
            *arguments,
        )
        process.says("obeys")
        return process

    def node(self, name: str = "test", port: int | None = None, robot: str | None = None) -> Node:
        """Return a node in this process that talks to the actuator."""
        endpoint = f"tcp/127.0.0.1:{port or self.port}"
        node = Node(name, robot or self.robot, BusSettings(connect=[endpoint], multicast=False))
        node.log.show = lambda line: None
        self._stack.callback(node.close)
        return node

    def hear(self, node: Node) -> None:
        """Wait until a node hears the robot's beat and knows its vehicle."""
        heard = node.membership.heard()

        def known() -> bool:
            heard.listen()
            return bool(heard.beat and heard.vehicle)

        until(known, "a beat")


def readme_program(robot: str) -> str:
    """Return the program in README as it stands, but for the robot's name."""
    (program,) = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    return str(program).replace("archangel", robot)


@contextmanager
def repeating(act: Callable[[], object], period: float) -> Iterator[None]:
    """Do something again and again meanwhile, as a key that is held or a program does."""
    ended = threading.Event()

    def run() -> None:
        realtime.follow()
        due = time.monotonic()
        while not ended.wait(max(0.0, due - time.monotonic())):
            due += period
            act()

    thread = threading.Thread(target=run, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def every(seconds: float, times: int) -> Iterator[int]:
    """Yield on a schedule: the rate of a stream, not a wait for something."""
    began = time.monotonic()
    for number in range(times):
        time.sleep(max(0.0, began + number * seconds - time.monotonic()))
        yield number
