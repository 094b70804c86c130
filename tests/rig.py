"""A robot on a bench: real processes on a real bus of their own, watched at the chip's registers."""

import os
import select
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing, suppress
from pathlib import Path
from typing import IO, Self

from zteleop.bus.node import Node
from zteleop.bus.session import BusSettings
from zteleop.drivers.registers import read_duty_ticks
from zteleop.drivers.simulated import open_registers

THROTTLE, STEERING = 0, 1
NEUTRAL = (375, 370)
PATIENCE = 10.0


def free_port() -> int:
    with closing(socket.socket()) as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def until(condition: Callable[[], object], what: str, patience: float = PATIENCE) -> float:
    """Wait for what no event tells of, such as a register; return the seconds it took."""
    began = time.monotonic()
    while not condition():
        assert time.monotonic() - began < patience, f"not within {patience} s: {what}"
        time.sleep(0.0005)
    return time.monotonic() - began


class Process:
    """A verb in a process of its own, whose lines can be awaited."""

    def __init__(self, arguments: Sequence[str], environment: dict[str, str], folder: Path) -> None:
        self.process = subprocess.Popen(
            [sys.executable, "-m", "zteleop", *arguments],
            env=environment,
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        self.lines: list[str] = []
        self._said = threading.Condition()
        assert self.process.stdout
        self._reader = threading.Thread(target=self._read, args=(self.process.stdout,), daemon=True)
        self._reader.start()

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

    def says(self, text: str, patience: float = PATIENCE) -> str:
        """Wait for a line that holds a text."""
        with self._said:
            found = self._said.wait_for(lambda: next((x for x in self.lines if text in x), None), patience)
        assert found, f"never said {text!r}:\n{self.text}"
        return found

    def signal(self, number: int) -> None:
        self.process.send_signal(number)

    def ends(self, patience: float = PATIENCE) -> int:
        """Wait for the end; return the exit code."""
        code = self.process.wait(patience)
        self._reader.join(patience)
        return code

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGCONT)
            self.process.kill()
        self.process.wait()
        self._reader.join()
        if self.process.stdout:
            self.process.stdout.close()


class Rig:
    """One robot with a simulated chip in a folder of its own, and everybody who talks to it."""

    robot = "bench"

    def __init__(self, folder: Path) -> None:
        self.folder = folder
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

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        self._stack.close()

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
        process = Process(arguments, self.environment, self.folder)
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


class Cable:
    """A TCP link that can be cut: what is sent through it afterwards goes nowhere, and nobody is told."""

    def __init__(self, port: int) -> None:
        self._target = port
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = int(self._listener.getsockname()[1])
        self._pairs: dict[socket.socket, socket.socket] = {}
        self._cut = threading.Event()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._carry, daemon=True)
        self._thread.start()

    def cut(self) -> None:
        self._cut.set()

    def mend(self) -> None:
        self._cut.clear()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        self._ended.set()
        self._thread.join()
        for end in [self._listener, *self._pairs]:
            end.close()

    def _carry(self) -> None:
        while not self._ended.is_set():
            ends = [] if self._cut.is_set() else [self._listener, *self._pairs]
            for end in select.select(ends, [], [], 0.01)[0]:
                if end is self._listener:
                    self._accept()
                else:
                    self._pass_on(end)

    def _accept(self) -> None:
        here, _ = self._listener.accept()
        try:
            there = socket.create_connection(("127.0.0.1", self._target))
        except OSError:
            here.close()
            return
        self._pairs |= {here: there, there: here}

    def _pass_on(self, end: socket.socket) -> None:
        other = self._pairs.get(end)
        if other is None:
            return
        data = b""
        with suppress(OSError):
            data = end.recv(65536)
            other.sendall(data)
        if not data:
            for closed in (end, other):
                self._pairs.pop(closed, None)
                closed.close()


def every(seconds: float, times: int) -> Iterator[int]:
    """Yield on a schedule: the rate of a stream, not a wait for something."""
    began = time.monotonic()
    for number in range(times):
        time.sleep(max(0.0, began + number * seconds - time.monotonic()))
        yield number
