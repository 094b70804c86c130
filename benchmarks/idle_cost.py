"""What a process of zteleop costs while nothing happens: memory of its own, and shares of one core."""

import subprocess
import sys
import time
from collections.abc import Callable
from itertools import cycle
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple, Protocol

from figures import is_quick, print_table, verdict
from robot import LEFT, RAW_LINE, RIGHT, Operator, Robot

MEMORY_TARGET, CPU_TARGET = 16.0, 3.0
SUBSCRIBER = """
from zteleop import BusSettings, Node, Odometry
with Node("bench", "bench", BusSettings(multicast=False, connect=[{endpoint!r}])) as node:
    node.subscription("odom", Odometry, print)
    node.spin()
"""
RAW_SUBSCRIBER = """
import sys
sys.path.insert(0, {folder!r})
from raw_line import open_session, zenoh
with open_session(**{{"connect/endpoints": [{endpoint!r}]}}) as session:
    subscriber = session.declare_subscriber("robot/bench/odom", zenoh.handlers.RingChannel(10))
    while True:
        subscriber.recv()
"""


class Running(Protocol):
    """A process that somebody runs."""

    pid: int


SUBSCRIBED = "subscriber: Node, handler"
PEER = "peer: raw zenoh subscriber"
PARTS = ("door", "actuator", "blackbox")
"""What a watchdog starts."""


def parts_of(watchdog: Running) -> dict[str, Running]:
    """Return the watchdog of a robot, and what it has started."""
    found: dict[str, Running] = {"watchdog": watchdog}
    for child in Path(f"/proc/{watchdog.pid}/task/{watchdog.pid}/children").read_text().split():
        words = Path(f"/proc/{child}/cmdline").read_bytes().split(b"\0")
        found |= {name: SimpleNamespace(pid=int(child)) for name in PARTS if name.encode() in words[3:]}
    return found


def private_mb(process: Running) -> float:
    """Return the memory that would be free without this process."""
    lines = Path(f"/proc/{process.pid}/smaps_rollup").read_text().splitlines()
    return sum(int(line.split()[1]) for line in lines if line.startswith("Private_")) / 1024


def cpu_seconds(process: Running) -> float:
    """Return how long all threads of a process have run, to the nanosecond."""
    tasks = Path(f"/proc/{process.pid}/task").glob("*/schedstat")
    return sum(int(task.read_text().split()[0]) for task in tasks) / 1e9


class Cost(NamedTuple):
    """What a process costs: MB of its own, and percent of a core at rest and driven."""

    mb: float
    idle: float
    driven: float


def measure(seconds: float) -> dict[str, Cost]:
    """Return what each process of a robot, of its operator and of others costs."""
    with Robot() as robot:
        operator = Operator(robot)
        for _ in operator.steer(20):
            pass
        processes = {
            **parts_of(robot.actuator),
            "keyboard": operator.process,
            "sim": robot.start("sim", "--connect", robot.endpoint, "--listen", "tcp/127.0.0.1:0"),
            SUBSCRIBED: _python(robot, SUBSCRIBER),
            PEER: _python(robot, RAW_SUBSCRIBER),
        }
        time.sleep(6)  # until the operator counts as idle
        idle = _shares(processes, lambda: time.sleep(seconds))
        driven = _shares(processes, lambda: _drive(operator, seconds))
        return {
            name: Cost(private_mb(process), idle[name], driven[name]) for name, process in processes.items()
        }


def in_all(costs: dict[str, Cost]) -> Cost:
    """Return what a robot costs: all that its watchdog has started, and that itself."""
    parts = [costs[name] for name in ("watchdog", *PARTS)]
    return Cost(*(sum(figures) for figures in zip(*parts, strict=True)))


def main() -> None:
    seconds = 2.0 if is_quick(__doc__) else 10.0
    costs = measure(seconds)
    rows: list[tuple[object, ...]] = []
    for name, cost in costs.items():
        target = "" if name == PEER else verdict(cost.mb, MEMORY_TARGET, "MB")
        ours = name in ("watchdog", "actuator", "door")
        cpu = verdict(max(cost.idle, cost.driven), CPU_TARGET, "%") if ours else ""
        rows.append((name, cost.mb, target, cost.idle, cost.driven, cpu))
    mb, idle, driven = in_all(costs)
    rows.insert(len(PARTS) + 1, ("the robot in all", mb, "", idle, driven, ""))
    head = ["process", "own MB", "target", "% idle", "% driven", "target"]
    print_table(f"memory and share of one core over {seconds:g} s, at rest and driven at 20 Hz", head, rows)


def _shares(processes: dict[str, Running], act: Callable[[], None]) -> dict[str, float]:
    """Return the percentage of one core that each process takes during an act."""
    before, began = {name: cpu_seconds(process) for name, process in processes.items()}, time.monotonic()
    act()
    elapsed = time.monotonic() - began
    return {name: 100 * (cpu_seconds(processes[name]) - then) / elapsed for name, then in before.items()}


def _drive(operator: Operator, seconds: float) -> None:
    """Steer from one step of left to two and back, a key a second; between keys commands are repeated."""
    end = time.monotonic() + seconds
    operator.press(LEFT)
    for key in cycle((LEFT, RIGHT)):
        operator.press(key)
        time.sleep(min(1.0, max(0.0, end - time.monotonic())))
        if time.monotonic() >= end:
            break


def _python(robot: Robot, program: str) -> "subprocess.Popen[str]":
    text = program.format(endpoint=robot.endpoint, folder=str(Path(RAW_LINE).parent))
    return robot.start_program([sys.executable, "-c", text])


if __name__ == "__main__":
    main()
