"""A robot and its operator on two machines, and a witness who sees nothing but the chip."""

import os
import signal
import sys
import threading
import time
from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Self

from faults.link.network import ROBOT, Network, inside
from faults.link.timecode import Ticks, age
from rig import NEUTRAL, ZTELEOP, Process, Rig, until

PORT, VIDEO_PORT = 7447, 7448
FRESH = 0.3 + 0.02
"""s, the age of the oldest command that may be executed, and what measuring it costs"""
LOOK = 0.001
TESTS = Path(__file__).parents[2]
FALSE_ALARM = "stops the robot"
"""What the watchdog says when it believes that the robot moves without a reason."""
CONFIG = """
[drive.cap]
stopping_distance = 1000.0

[drive.servos.steering]
channel = 1
min_us = 1183.2
neutral_us = 1530.0
max_us = 1876.8

[drive.servos.throttle]
channel = 0
min_us = 897.6
neutral_us = 1509.6
max_us = 2040.0
slew_rate = 1e6

[drivers.simulated]
path = "{chip}"
"""
"""Donkeycar's calibration, and no bound on how fast or how far it goes: what is slowed down shows no code."""


class Witness:
    """Looks at the chip all the time; knows when each command was executed, and how old it was then."""

    def __init__(self, rig: Rig) -> None:
        self._rig = rig
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._look, daemon=True)
        self.motions: list[tuple[float, float]] = []
        """when a command was executed, and its age then"""
        self.rests: list[float] = []
        """when the chip came to rest"""
        self.strange: set[Ticks] = set()
        """pulses that nobody commanded"""

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *exc: object) -> None:
        self._ended.set()
        self._thread.join()

    @property
    def stale(self) -> int:
        return sum(age > FRESH for _, age in self.motions)

    def oldest(self, since: float) -> float:
        return max((age for at, age in self.motions if at >= since), default=0.0)

    def moved(self, since: float, until: float = float("inf")) -> int:
        """Return how many commands were executed in that time."""
        return sum(since < at < until for at, _ in self.motions)

    def _look(self) -> None:
        before: Ticks = NEUTRAL
        while not self._ended.wait(LOOK):
            ticks, now = self._rig.ticks, time.monotonic()
            if ticks != before:
                self._note(ticks, now)
            before = ticks

    def _note(self, ticks: Ticks, now: float) -> None:
        old = age(ticks, now)
        if ticks == NEUTRAL:
            self.rests.append(now)
        elif old is not None:
            self.motions.append((now, old))
        elif None not in ticks:  # a chip that was just switched on gives no pulse
            self.strange.add(ticks)


class FarRig(Rig):
    """A robot whose processes run on a machine of their own."""

    def __init__(self, folder: Path, network: Network, clocks: Mapping[str, str]) -> None:
        super().__init__(folder)
        self._network = network
        self.environment |= clocks
        (folder / "config.toml").write_text(CONFIG.format(chip=self.chip))

    @property
    def endpoint(self) -> str:
        return f"tcp/{ROBOT}:{PORT}"

    @property
    def pids(self) -> list[int]:
        return [*super().pids, *self._network.pids]

    def run(self, *arguments: str) -> Process:
        return self.start(self._network.robot, [*ZTELEOP, *arguments], self.environment)

    def start(self, namespace: str, command: Sequence[str], environment: Mapping[str, str]) -> Process:
        """Run a command on one of the machines."""
        surroundings = {**environment, "PYTHONPATH": str(TESTS)}
        return self.keep(Process([*inside(namespace), *command], surroundings, self.folder))


class LinkBench:
    """A robot that is driven from another machine; `network` disturbs what lies between."""

    def __init__(
        self,
        network: Network,
        folder: Path,
        *,
        operator: Sequence[str] = (),
        router: bool = False,
        clocks: Mapping[str, Mapping[str, str]] = {},
    ) -> None:
        self.network = network
        self.rig = FarRig(folder, network, clocks.get("robot", {}))
        self._options = [*operator, *(("--mode", "client") if router else ())]
        self._routed = router
        self._clocks = clocks
        self._stack = ExitStack()
        self._stack.enter_context(self.rig)

    def __enter__(self) -> Self:
        try:
            self.witness = self._stack.enter_context(Witness(self.rig))
            if self._routed:
                self.start_router()
            self.start_robot()
            self.start_operator()
            self.moves()
        except BaseException:
            self._stack.close()
            raise
        return self

    def __exit__(self, *exc: object) -> None:
        self._stack.close()

    def start_router(self) -> None:
        """Start what both are clients of, on the robot's side of the cable."""
        command = [sys.executable, "-m", "faults.link.router", self.rig.endpoint]
        self.router = self.rig.start(self.network.robot, command, self.rig.environment)
        self.router.says("ready")

    def start_robot(self) -> None:
        where = ["--mode", "client", "--connect"] if self._routed else ["--listen"]
        bus = ["--robot", self.rig.robot, "--no-multicast-scouting", *where, self.rig.endpoint]
        self.watchdog = self.rig.run("actuator", *bus)
        self.watchdog.says("obeys")

    def start_operator(self) -> None:
        command = [sys.executable, "-m", "faults.link.sender", self.rig.robot, self.rig.endpoint]
        environment = {**self.rig.environment, **self._clocks.get("operator", {})}
        self.operator = self.rig.start(self.network.operator, [*command, *self._options], environment)

    def start_video(self) -> Process:
        """Let the operator's machine watch pictures, in processes apart from those that drive."""
        program = [sys.executable, "-m", "faults.link.video"]
        where = f"tcp/{ROBOT}:{VIDEO_PORT}"
        self.rig.start(self.network.robot, [*program, "send", where], self.rig.environment)
        viewer = self.rig.start(self.network.operator, [*program, "view", where], self.rig.environment)
        viewer.says("saw")
        return viewer

    @property
    def at_rest(self) -> bool:
        return self.rig.ticks == NEUTRAL

    @property
    def heard(self) -> float:
        """When the operator last heard the robot."""
        told = [line for line in self.operator.lines if line.startswith("heard")]
        return float(told[-1].split()[1]) if told else 0.0

    @property
    def alarms(self) -> list[str]:
        return [line for line in self.watchdog.lines if FALSE_ALARM in line]

    def begin_anew(self) -> None:
        """Let the operator let go, and begin again."""
        self.operator.signal(signal.SIGUSR1)

    def moves(self) -> None:
        """Wait until the robot executes a command."""
        since = time.monotonic()
        until(lambda: self.witness.moved(since), "motion")

    def is_heard_again(self) -> None:
        """Wait until the operator hears what the robot says now."""
        since = time.monotonic()
        until(lambda: self.heard > since, "the robot at its operator")

    def signal_robot(self, number: int) -> None:
        """Send a signal to both of the robot's processes."""
        child = self.watchdog.child
        assert child
        for process in (child, self.watchdog.process.pid):
            os.kill(process, number)
