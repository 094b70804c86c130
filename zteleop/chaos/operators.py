"""Who drives the robot on a bench, and goes on whatever happens to it."""

import os
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from zteleop.bus.node import Node
from zteleop.chaos.bench import Bench, endpoint
from zteleop.chaos.process import ZTELEOP
from zteleop.chaos.terminal import Terminal
from zteleop.messages import Twist

PERIOD = 0.02
IN_TERMINAL = """
import fcntl, os, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
os.execv(sys.executable, [sys.executable, *sys.argv[1:]])
"""


@contextmanager
def here(bench: Bench, node: Node | None = None) -> Iterator[None]:
    """Command from this process, 50 times a second; each is an act."""
    motors = (node or bench.node).publisher("cmd_vel", Twist, source="keyboard")
    ended = threading.Event()

    def drive() -> None:
        due = time.monotonic()
        while not ended.wait(max(0.0, due - time.monotonic())):
            due += PERIOD
            motors.publish(bench.command)

    thread = threading.Thread(target=drive, daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


@contextmanager
def far(bench: Bench) -> Iterator[None]:
    """Command from this process, behind a cable that can be cut."""
    place = bench.place.folder / "cable"
    bench.lay_cable(place)
    with here(bench, bench.join(place)):
        yield


@contextmanager
def program(bench: Bench) -> Iterator[None]:
    """Command from a program of its own, 50 times a second."""
    linear, angular = bench.command.linear.x, bench.command.angular.z
    values = f"{{linear: {{x: {linear}}}, angular: {{z: {angular}}}}}"
    command = [*ZTELEOP, "pub", "cmd_vel/keyboard", "Twist", values, "-r", "50", *_where(bench)]
    bench.operator = bench.run("operator", command)
    yield


@contextmanager
def keyboard(bench: Bench) -> Iterator[None]:
    """Drive with the keys of a terminal, which is pressed until the robot moves."""
    bench.terminal = terminal = Terminal()
    command = [sys.executable, "-c", IN_TERMINAL, "-m", "zteleop", "keyboard", "--drive", "step"]
    bench.operator = process = bench.run("operator", [*command, *_where(bench)], terminal.device)
    os.close(terminal.device)
    try:
        yield
    finally:
        process.end()
        terminal.close()


OPERATORS = {"here": here, "far": far, "program": program, "keyboard": keyboard}


def _where(bench: Bench) -> list[str]:
    bus = ["--mode", "client", "--connect", endpoint(bench.place.address), "--no-multicast-scouting"]
    return ["--robot", bench.place.robot, *bus]
