"""The actuator proper: `zteleop actuator` starts it, and watches over it."""

import sys
from pathlib import Path

import msgspec

from zteleop import config
from zteleop.bus.node import Node
from zteleop.config import Config
from zteleop.control.standing import Standing
from zteleop.drivers import open_driver
from zteleop.errors import ConfigError, DeviceError
from zteleop.machine import link, orphan, realtime
from zteleop.machine.health import Health
from zteleop.machine.limits_file import LimitsFile
from zteleop.machine.link import ActuatorEnd
from zteleop.machine.stop_file import StopFile
from zteleop.nodes.actuator import Actuator
from zteleop.processes import PROGRAMS
from zteleop.recording.journal import Journal

PROGRAM = PROGRAMS["actuator"]
SIMULATED = "the chip is simulated: zteleop sim moves a robot by it; --driver pca9685 writes to a real one"


def run(number: int) -> int:
    """Obey commands with the orders on stdin, under the watchdog at the other end of a socket."""
    settings, standing = orders(sys.stdin.buffer.read())
    robot = settings.robot or ""
    end = _adopt(number)
    with Node("actuator", robot, settings.bus) as node:
        # What is refused here, the watchdog was refused as well, and has said so.
        realtime.ask_for(PROGRAM.priority, PROGRAM.oom_score)
        if settings.driver == "simulated" and standing is None:
            node.log.info(SIMULATED)
        orphan.notice(lambda: node.membership.loop.fail(link.gone()))
        folder = config.state_folder(robot)
        chip = settings.driver_settings(settings.driver, robot)
        Actuator(
            node,
            settings.drive,
            open_driver(settings.driver, chip, exclusive=False),
            end,
            StopFile(folder / "stop", node.log.error),
            LimitsFile(folder / "limits.json"),
            Journal(folder, settings.journal, node.log.warn),
            Health(Path("/sys"), node.log),
            standing,
        ).run()
    return 0


def orders(text: bytes) -> tuple[Config, Standing | None]:
    """Return the settings a watchdog gives its actuator, and whose place it takes; raises ConfigError."""
    settings, _, standing = text.partition(b"\n")
    try:
        return (
            msgspec.json.decode(settings, type=Config),
            msgspec.json.decode(standing or b"null", type=Standing | None),
        )
    except (msgspec.MsgspecError, ValueError, RecursionError) as error:
        raise ConfigError(
            f"expected a watchdog's settings on standard input: {error}; zteleop actuator starts both"
        ) from None


def _adopt(number: int) -> ActuatorEnd:
    try:
        return link.adopt(number)
    except (OSError, ValueError, OverflowError):
        raise DeviceError(f"file {number} is no watchdog's; zteleop actuator starts both") from None
