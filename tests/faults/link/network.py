"""Two machines in one: network namespaces with a cable between them that can be disturbed."""

import json
import os
import re
import shutil
import socket
import subprocess
import sys
import threading
from collections.abc import Callable
from contextlib import ExitStack
from functools import cache
from itertools import count
from pathlib import Path
from typing import Self, TypeVar

from faults.link.emulator import DEVICE, Way, enter

T = TypeVar("T")
OPERATOR, ROBOT = "10.77.0.1", "10.77.0.2"
"""Where each of the two is reached."""
SOUND = Way()
DEAD = Way(dead=True)
_TESTS = Path(__file__).parents[2]
_OURS = re.compile(r"zteleop-(\d+)-\d+-\w+")
_numbers = count()


@cache
def obstacle() -> str:
    """Say why networks cannot be disturbed on this machine; nothing where they can."""
    if not sys.platform.startswith("linux") or os.geteuid() != 0:
        return "disturbing a network needs Linux and root (sudo .venv/bin/pytest tests/faults)"
    if not shutil.which("ip"):
        return "disturbing a network needs the program ip (sudo apt install iproute2)"
    if not os.path.exists("/dev/net/tun"):
        return "disturbing a network needs /dev/net/tun (sudo modprobe tun)"
    probe = f"zteleop-{os.getpid()}-probe"
    try:
        _ip("netns", "add", probe)
        _ip("netns", "del", probe)
    except (OSError, RuntimeError) as error:
        return f"disturbing a network needs network namespaces, which this container has not: {error}"
    return ""


class Network:
    """An operator's machine and a robot's, each a namespace, joined by one cable.

    Raises OSError or RuntimeError where the kernel gives no namespaces or no TAP devices.
    """

    def __init__(self, seed: int = 0) -> None:
        name = f"zteleop-{os.getpid()}-{next(_numbers)}"
        self.operator, self.robot = f"{name}-operator", f"{name}-robot"
        self._seed = seed
        self._address = OPERATOR
        self._stack = ExitStack()

    def __enter__(self) -> Self:
        _sweep()
        try:
            self._build()
        except BaseException:
            self._stack.close()
            raise
        return self

    def __exit__(self, *exc: object) -> None:
        self._stack.close()

    @property
    def pids(self) -> list[int]:
        """The cable's own process."""
        return [self._cable.pid]

    def _build(self) -> None:
        for namespace in (self.operator, self.robot):
            _ip("netns", "add", namespace)
            self._stack.callback(_ip, "netns", "del", namespace)
        self._cable = self._stack.enter_context(self._start())
        self._stack.callback(self._end)
        self._hear("ready")
        for namespace, address in ((self.operator, OPERATOR), (self.robot, ROBOT)):
            _ip("-n", namespace, "link", "set", "lo", "up")
            # No IPv6: nobody then speaks on the cable but those who are asked to.
            _ip("-n", namespace, "link", "set", DEVICE, "addrgenmode", "none")
            _ip("-n", namespace, "addr", "add", f"{address}/24", "dev", DEVICE)
            _ip("-n", namespace, "link", "set", DEVICE, "up")

    def _start(self) -> "subprocess.Popen[str]":
        command = [
            sys.executable,
            "-m",
            "faults.link.emulator",
            self.operator,
            self.robot,
            "--seed",
            str(self._seed),
        ]
        pipe = subprocess.PIPE
        return subprocess.Popen(command, cwd=_TESTS, stdin=pipe, stdout=pipe, stderr=pipe, text=True)

    def _end(self) -> None:
        self._cable.kill()
        self._cable.wait()

    def _hear(self, wanted: str) -> None:
        assert self._cable.stdout
        assert self._cable.stderr
        if self._cable.stdout.readline().strip() != wanted:
            raise RuntimeError(f"the cable failed: {self._cable.stderr.read().strip()}")

    def set(self, forth: Way = SOUND, back: Way | None = None) -> None:
        """Disturb the way forth, to the robot, and the way back (as the way forth, unless told)."""
        order = {"forth": forth._asdict(), "back": (forth if back is None else back)._asdict()}
        assert self._cable.stdin
        self._cable.stdin.write(f"{json.dumps(order)}\n")
        self._cable.stdin.flush()
        self._hear("set")

    def move_operator(self, address: str) -> None:
        """Give the operator's machine another address, as a router does, or another Wi-Fi."""
        _ip("-n", self.operator, "addr", "del", f"{self._address}/24", "dev", DEVICE)
        _ip("-n", self.operator, "addr", "add", f"{address}/24", "dev", DEVICE)
        self._address = address

    def socket(self, namespace: str, kind: socket.SocketKind = socket.SOCK_DGRAM) -> socket.socket:
        """Return a socket of this process that speaks from one of the machines."""
        return _in_namespace(namespace, lambda: socket.socket(type=kind))


def inside(namespace: str) -> list[str]:
    """Return what to put in front of a command so that it runs in a namespace."""
    return ["ip", "netns", "exec", namespace]


def _in_namespace(namespace: str, act: Callable[[], T]) -> T:
    """Do something in a thread that has entered a namespace; the process stays where it is."""
    results: list[T] = []

    def run() -> None:
        enter(namespace)
        results.append(act())

    thread = threading.Thread(target=run)
    thread.start()
    thread.join()
    return results[0]


def _sweep() -> None:
    """Delete namespaces that a killed run has left behind."""
    for name in _ip("netns", "list").split():
        found = _OURS.fullmatch(name)
        if found and not Path(f"/proc/{found[1]}").exists():
            _ip("netns", "del", name)


def _ip(*arguments: str) -> str:
    done = subprocess.run(["ip", *arguments], capture_output=True, text=True)
    if done.returncode:
        raise RuntimeError(f"ip {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout
