"""What can happen to a robot that drives, and how long its wheels may turn on after it."""

import os
import secrets
import signal
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

import preload
from rig import NEUTRAL, Process, Rig, every, repeating, until

from zteleop.bus.node import Node
from zteleop.messages import Pwm, Stop

FORWARD = Pwm(390, 400)
DRIVEN = (390, 400)
STREAM = 0.02
QUIET = 0.6


class Bench:
    """A robot that is driven at 50 Hz, by a node of this process or by a process of its own."""

    def __init__(self, rig: Rig, watchdog: Process, node: Node, sender: Process | None) -> None:
        self.rig, self.watchdog, self.node, self.sender = rig, watchdog, node, sender

    @property
    def actuator(self) -> int:
        child = self.watchdog.child
        assert child, f"no actuator runs:\n{self.watchdog.text}"
        return child

    def signal_both(self, number: int) -> None:
        for pid in (self.actuator, self.watchdog.process.pid):
            os.kill(pid, number)


class Fault(NamedTuple):
    """Something that happens while the robot drives."""

    name: str
    bound: float
    """s until neutral"""
    strike: Callable[[Bench], object]
    stays: bool = True
    """It must not move again although its operator goes on."""
    alone: bool = False
    """The sender is a process of its own."""


def stand_still(bench: Bench) -> None:
    """Stop both processes for 3 s while commands pile up, and let them go on."""
    bench.signal_both(signal.SIGSTOP)
    time.sleep(3.0)
    bench.signal_both(signal.SIGCONT)


def press_stop(bench: Bench) -> None:
    stops = bench.node.publisher("stop", Stop)
    stops.publish(Stop(engaged=True, id=secrets.randbits(53), by="the test", why=""))


def to_actuator(number: int) -> Callable[[Bench], None]:
    return lambda bench: os.kill(bench.actuator, number)


def to_watchdog(number: int) -> Callable[[Bench], None]:
    return lambda bench: bench.watchdog.signal(number)


def to_sender(number: int) -> Callable[[Bench], None]:
    def strike(bench: Bench) -> None:
        assert bench.sender
        bench.sender.signal(number)

    return strike


FAULTS = (
    Fault("actuator killed", 0.05, to_actuator(signal.SIGKILL)),
    Fault("actuator crashes", 0.05, to_actuator(signal.SIGSEGV)),
    Fault("actuator frozen", 0.4, to_actuator(signal.SIGSTOP)),
    Fault("actuator told to end", 0.05, to_actuator(signal.SIGTERM)),
    Fault("watchdog killed", 0.05, to_watchdog(signal.SIGKILL)),
    Fault("watchdog frozen", 0.5, to_watchdog(signal.SIGSTOP)),
    Fault("watchdog told to end", 0.05, to_watchdog(signal.SIGTERM)),
    Fault("both stood still for 3 s", 0.05, stand_still),
    Fault("stop pressed", 0.03, press_stop),
    Fault("sender killed", 0.05, to_sender(signal.SIGKILL), alone=True),
    Fault("sender frozen", 0.35, to_sender(signal.SIGSTOP), alone=True),
)


def on_i2c(rig: Rig) -> None:
    """Give the robot the real driver, on an emulated /dev/i2c-1 whose chip is where the simulated one was."""
    rig.environment |= preload.environment(preload.library(rig.folder), rig.chip)
    config = "[drivers.pca9685]\nbus = 1\narming = 0.1\n"
    (rig.folder / "config.toml").write_text(f'driver = "pca9685"\n{config}')


@contextmanager
def driven(
    folder: Path, *, alone: bool, prepare: Callable[[Rig], object] = lambda _: None
) -> Iterator[Bench]:
    """Start a robot, and somebody who drives it."""
    folder.mkdir(exist_ok=True)
    with Rig(folder) as rig:
        prepare(rig)
        watchdog = rig.actuator()
        node = rig.node()
        rig.hear(node)
        if alone:
            values = f"{{steering_ticks: {FORWARD.steering_ticks}, throttle_ticks: {FORWARD.throttle_ticks}}}"
            sender = rig.join("pub", "pwm/keyboard", "Pwm", values, "-r", "50")
            until(lambda: rig.ticks == DRIVEN, "the command on the chip")
            yield Bench(rig, watchdog, node, sender)
            return
        publisher = node.publisher("pwm", Pwm, source="keyboard")
        with repeating(lambda: publisher.publish(FORWARD), STREAM):
            until(lambda: rig.ticks == DRIVEN, "the command on the chip")
            yield Bench(rig, watchdog, node, None)


def measure(fault: Fault, bench: Bench) -> float:
    """Let it happen; return the seconds until the chip is neutral, where it must then stay."""
    fault.strike(bench)
    seconds = until(lambda: bench.rig.ticks == NEUTRAL, f"neutral after: {fault.name}", 5.0)
    if fault.stays:
        for _ in every(0.001, round(QUIET * 1000)):
            assert bench.rig.ticks == NEUTRAL, f"it moved again after: {fault.name}"
    return seconds
