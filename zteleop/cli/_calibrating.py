"""A robot whose servos may turn as far as any, and somebody who watches the wheels and answers."""

import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from msgspec.structs import replace

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.cli import _options
from zteleop.cli._driving import drive_at_terminal
from zteleop.cli._scratch import scratch
from zteleop.cli._settings_file import SettingsFile, of_servos
from zteleop.cli.neutral import bring_to_rest
from zteleop.config import Config
from zteleop.control.measuring import Measuring, Step
from zteleop.control.servo import Servo
from zteleop.drivers import open_driver
from zteleop.errors import BusError, ConfigError
from zteleop.inputs.levers import Steps
from zteleop.inputs.tuner import Tuner
from zteleop.machine.leash import Process, last_words, leashed
from zteleop.screen.dashboard import Dashboard, Task
from zteleop.screen.view import View
from zteleop.terminal.typed import Typed, open_terminal

TICK = Steps(1, 1)
"""what a press turns"""
START = 10.0
"""s in which the robot is ready, its ESC armed"""
READY = " obeys"
"""what an actuator says that has the robot to itself"""
KNOWN = (
    "the motor's neutral is known, {ticks} ticks: the robot starts anew with it, two seconds or so; "
    "if a wheel turns then, q ends that"
)
SLOW = 0.1
"""m/s at full throttle, as this robot is told: no limit of speed then keeps a motor from its end"""
CREEP = SLOW / 1000
"""m/s: so little of a wide servo is within the dead zone of any motor"""


class Seat(NamedTuple):
    """Where somebody sits who answers: `sit` returns when a part is over, or he has left."""

    source: str
    """what his commands are said as, and nobody else turns anything"""
    sit: Callable[[Node, Measuring], Tuner]


def find_out(
    file: SettingsFile, settings: Config, robot: str, steps: Sequence[Step], seat: Seat
) -> dict[str, Servo] | None:
    """Return both servos as somebody found them in these steps; None when he left before the end.

    Raises BusError when the robot does not start, ConfigError when what was found makes no servo.
    """
    chip = settings.driver_settings(settings.driver, robot)
    open_driver(settings.driver, chip).close()  # which fails where somebody else drives it
    measuring = Measuring(settings.drive.servos, settings.tick_us, steps)
    while True:
        with running(file, settings, robot, measuring, seat.source) as node:
            tuner = seat.sit(node, measuring)
        if tuner.gave_up:
            bring_to_rest(settings, settings.driver, robot)  # what was tried is not what the car knows
            return None
        if measuring.is_done:
            break
        print(KNOWN.format(ticks=round(measuring.neutral_us / settings.tick_us)), file=sys.stderr, flush=True)
        measuring.go_on()
    try:
        return measuring.servos()
    except ValueError as error:
        bring_to_rest(settings, settings.driver, robot)
        raise ConfigError(f"what was found makes no car: {error}; nothing is written") from None


def at_terminal(settings: Config) -> Seat:
    """Return the seat before this terminal."""

    def sit(node: Node, measuring: Measuring) -> Tuner:
        tuner = Tuner(Typed(open_terminal()), measuring)
        known = Dashboard(node.robot or "", "step", settings.speeds, bound=tuner.bound, steps=TICK)
        task = asked_by(tuner, measuring)
        drive_at_terminal(node, settings, tuner, "keyboard", known, watch=seen_by(tuner), task=task)
        return tuner

    return Seat("keyboard", sit)


def seen_by(tuner: Tuner) -> Callable[[View], None]:
    """Return what tells a tuner what leaves the chip."""

    def see(view: View) -> None:
        tuner.see(view.status.pulses if view.status and not view.silence else ())

    return see


def asked_by(tuner: Tuner, measuring: Measuring) -> Callable[[], Task]:
    """Return what tells a screen what is asked for."""
    return lambda: Task(tuner.task(), unmeasured=not measuring.step.drives)


@contextmanager
def running(
    file: SettingsFile, settings: Config, robot: str, measuring: Measuring, source: str
) -> Iterator[Node]:
    """Run the actuator of the robot itself, with wide servos, and join the bus beside it."""
    from zteleop.terminal.hush import hushed  # which some systems have not, that are told so elsewhere

    with ExitStack() as stack, ExitStack() as quiet:
        quiet.enter_context(hushed())  # between two screens keys go on being pressed
        folder = stack.enter_context(scratch("zteleop-calibrate-"))
        log = stack.enter_context((folder / "log").open("w"))
        (folder / "config.toml").write_text(wide(file, settings, robot, measuring, source), encoding="utf-8")
        verb = ("actuator", "--config", str(folder / "config.toml"), "--robot", robot)
        process = stack.enter_context(leashed(verb, log, {}))
        beside = _options.beside_robot(replace(settings, robot=robot))
        node = stack.enter_context(_options.join("calibrate", beside))
        await_ready(node, process, Path(log.name))
        quiet.close()
        yield node
        with hushed():
            stack.close()


def wide(file: SettingsFile, settings: Config, robot: str, measuring: Measuring, source: str) -> str:
    """Return the text of a config that is the robot's, but for how far its servos turn."""
    bus, lifted = settings.bus, not measuring.step.drives
    changes: dict[tuple[str, ...], Any] = {
        **of_servos(measuring.wide()),
        ("drive", "mixer", "kind"): settings.drive.mixer.kind,
        **{("bus", name): getattr(bus, name) for name in ("mode", "connect", "listen", "multicast")},
    }
    if lifted:
        changes["drive", "mixer", "max_speed"] = SLOW
    for name, other in settings.drive.known_sources.items() if lifted else ():
        if name != source:  # a program that was left running turns no motor now
            changes["drive", "sources", name, "priority"] = other.priority
            changes["drive", "sources", name, "max_speed"] = CREEP
    if settings.driver == "simulated":
        changes["drivers", "simulated", "path"] = settings.driver_settings("simulated", robot)["path"]
    return file.changed(changes)[0]


def await_ready(node: Node, process: Process, log: Path) -> None:
    """Wait until the robot takes commands; raises BusError with its last words when it does not."""
    give_up = clock.now() + START
    while clock.now() < give_up and process.poll() is None:
        if READY in log.read_text() and node.membership.heard().ready:
            return
        node.spin(0.01)
    raise BusError(f"the robot did not start: {last_words(log)}")
