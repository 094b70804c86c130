"""A robot on a bench: real processes on a real bus of their own, watched at the chip's registers."""

import os
import pty
import re
import signal
import socket
import subprocess
import sys
import termios
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from fcntl import ioctl
from pathlib import Path
from struct import pack
from typing import IO, Any, Self, TypeVar

import pyte
import zenoh

from zteleop.bus.node import Node
from zteleop.bus.session import BusSettings, open_session
from zteleop.bus.subscription import Subscription
from zteleop.drivers.registers import read_duty_ticks
from zteleop.drivers.simulated import open_registers
from zteleop.messages import Message
from zteleop.nodes import realtime

M = TypeVar("M", bound=Message)
ROOT = Path(__file__).parents[1]
THROTTLE, STEERING = 0, 1
NEUTRAL = (375, 370)
PATIENCE = 30.0 * float(os.environ.get("ZTELEOP_PATIENCE", "1"))
"""s until an event that is awaited is given up: no claim, only the end of hope"""
ZTELEOP = (sys.executable, "-m", "zteleop")
TAKE_TERMINAL = """
import fcntl, os, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
os.execv(sys.executable, [sys.executable, *sys.argv[1:]])
"""


class Unmet(AssertionError):  # noqa: N818  not always an error of the product
    """What was awaited never came: a machine alone can do that, which keeps a robot from its core.

    Whoever drove must begin anew then, and a test does not. See `judging.py`.
    """


def free_port() -> int:
    with closing(socket.socket()) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def until(condition: Callable[[], object], what: str) -> None:
    """Wait for what no event tells of, such as a register; how long it takes is `verdict`'s to judge."""
    began = time.monotonic()
    while not condition():
        if time.monotonic() - began >= PATIENCE:
            raise Unmet(f"not within {PATIENCE:g} s: {what}")
        time.sleep(0.0005)


def hear(inbox: Subscription[M], wanted: Callable[[M], bool], what: str) -> M:
    """Wait for a message; an inbox itself would wait for ever."""
    found: list[M] = []

    def look() -> bool:
        found.extend(received.message for received in inbox.take() if wanted(received.message))
        return bool(found)

    until(look, what)
    return found[0]


_started: list["Process"] = []
"""Processes whose words a failed test shows."""


def words() -> list[tuple[str, str]]:
    """Return the command and the last words of every process that was started and not forgotten."""
    return [(" ".join(process.command[-9:])[-100:], process.text[-3000:]) for process in _started]


def pids() -> list[int]:
    """Return every process that was started and runs, an actuator after its watchdog."""
    found = [(process.process.pid, process.child) for process in _started if process.process.poll() is None]
    return [pid for pair in found for pid in pair if pid]


def forget_the_ended() -> None:
    """Leave out the processes of tests that are over."""
    _started[:] = [process for process in _started if process.process.poll() is None]


class Process:
    """A process of its own, whose lines can be awaited."""

    def __init__(self, command: Sequence[str], environment: Mapping[str, str], folder: Path) -> None:
        self._said = threading.Condition()
        self.lines: list[str] = []
        self._start(command, environment, folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)

    def _start(
        self,
        command: Sequence[str],
        environment: Mapping[str, str],
        folder: Path,
        stdin: int,
        stdout: int,
    ) -> None:
        self.process = subprocess.Popen(
            command,
            env=environment,
            cwd=folder,
            stdin=stdin,
            stdout=stdout,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        self.command = command
        self._reader = threading.Thread(target=self._read, args=(self.process.stdout,), daemon=True)
        self._reader.start()
        _started.append(self)

    def _read(self, output: IO[bytes]) -> None:
        for line in output:
            with self._said:
                self.lines.append(line.decode(errors="replace").rstrip("\n"))
                self._said.notify_all()
        with self._said:
            self._said.notify_all()

    @property
    def text(self) -> str:
        return "\n".join(self.lines)

    def says(self, text: str) -> str:
        """Wait for a line that holds a text."""
        with self._said:
            found = self._said.wait_for(lambda: next((x for x in self.lines if text in x), None), PATIENCE)
        if not found:
            raise Unmet(f"never said {text!r}:\n{self.text}")
        return found

    def signal(self, number: int) -> None:
        self.process.send_signal(number)

    @property
    def child(self) -> int | None:
        """The actuator that this process started and watches over, if there is one now."""
        pid = self.process.pid
        with suppress(OSError):
            for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split():
                if b"--record" not in Path(f"/proc/{child}/cmdline").read_bytes().split(b"\0"):
                    return int(child)
        return None

    def ends(self) -> int:
        """Wait for the end; return the exit code."""
        code = self.process.wait(PATIENCE)
        self._reader.join(PATIENCE)
        return code

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
            self.process.kill()
        self.process.wait()
        self._reader.join()
        if self.process.stdout:
            self.process.stdout.close()


class Terminal(Process):
    """A process in the foreground of a terminal that controls it; what is shown can be awaited."""

    def __init__(
        self,
        arguments: Sequence[str],
        environment: Mapping[str, str],
        folder: Path,
        columns: int = 80,
        rows: int = 24,
    ) -> None:
        self._said = threading.Condition()
        self._screen = pyte.Screen(columns, rows)
        self._stream = pyte.ByteStream(self._screen)
        self.output = b""
        self._master, self._slave = pty.openpty()
        self._set_size(columns, rows)
        self.found = self.modes()
        command = [sys.executable, "-c", TAKE_TERMINAL, *arguments]
        self._start(command, environment, folder, stdin=self._slave, stdout=self._slave)

    @property
    def screen(self) -> str:
        with self._said:
            return "\n".join(line.rstrip() for line in self._screen.display)

    def modes(self) -> list[Any]:
        return termios.tcgetattr(self._slave)

    def type(self, keys: str) -> None:
        os.write(self._master, keys.encode())

    def resize(self, columns: int, rows: int) -> None:
        """Do what a terminal's window does when it is dragged larger or smaller."""
        with self._said:
            self._screen.resize(rows, columns)
        self._set_size(columns, rows)

    @property
    def text(self) -> str:
        return self.screen

    def shows(self, *texts: str) -> str:
        """Wait until all these texts are on the screen together; return the screen."""

        def found() -> bool:
            return all(text in "\n".join(self._screen.display) for text in texts)

        with self._said:
            seen = self._said.wait_for(found, PATIENCE)
        if not seen:
            raise Unmet(f"never showed {texts}:\n{self.screen}")
        return self.screen

    def is_as_found(self) -> None:
        """Wait until the terminal is left: its modes, its screen, its cursor and its way to paste."""

        def left() -> bool:
            return all(
                self.output.rfind(b"\x1b[?%s" % off) >= self.output.rfind(b"\x1b[?%s" % on)
                for on, off in ((b"1049h", b"1049l"), (b"25l", b"25h"), (b"2004h", b"2004l"))
            )

        with self._said:
            assert self._said.wait_for(left, PATIENCE), f"not left: {self.output[-200:]!r}"
        assert self.modes() == self.found

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        os.close(self._slave)
        self._reader.join()
        os.close(self._master)

    def ends(self) -> int:
        return self.process.wait(PATIENCE)

    def _set_size(self, columns: int, rows: int) -> None:
        """Set the size; the kernel tells whoever is in the foreground by SIGWINCH."""
        ioctl(self._slave, termios.TIOCSWINSZ, pack("HHHH", rows, columns, 0, 0))

    def _read(self, output: IO[bytes]) -> None:
        with suppress(OSError):  # EIO: nobody holds the other end any more
            while data := os.read(self._master, 65536):
                with self._said:
                    self.output += data
                    self._stream.feed(data)
                    self._said.notify_all()


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
        """Assert that whoever drives was never disturbed."""
        if self.seen != set(pulses):
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
        return self._keep(Process([*ZTELEOP, *arguments], self.environment, self.folder))

    def program(self, text: str, *arguments: str) -> Process:
        """Run somebody's Python program."""
        command = [sys.executable, "-c", text, *arguments]
        return self._keep(Process(command, self.environment, self.folder))

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
        self, *arguments: str, columns: int = 80, rows: int = 24, environment: Mapping[str, str] | None = None
    ) -> Terminal:
        """Sit down before a terminal with the keyboard's screen on it."""
        return self.terminal(
            "keyboard",
            *arguments,
            *self.bus_options(),
            columns=columns,
            rows=rows,
            environment=environment or {},
        )

    def terminal(
        self, *arguments: str, columns: int = 80, rows: int = 24, environment: Mapping[str, str] | None = None
    ) -> Terminal:
        """Run a verb in the foreground of a terminal."""
        surroundings = self.environment | {"TERM": "xterm-256color", "LC_ALL": "C.UTF-8"}
        surroundings |= environment or {}
        command = [*ZTELEOP[1:], *arguments]
        return self._keep(Terminal(command, surroundings, self.folder, columns, rows))

    def session(self) -> zenoh.Session:
        """Join the bus without any of zteleop's manners."""
        session = open_session(BusSettings(connect=[self.endpoint], multicast=False))
        self._stack.callback(session.close)
        return session

    @property
    def pids(self) -> list[int]:
        """Every process of the robot and of who talks to it; an actuator after its watchdog."""
        found = [(process.process.pid, process.child) for process in self._processes]
        return [pid for pair in found for pid in pair if pid]

    def _keep(self, process: P) -> P:
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
        heard = node.heard()

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
