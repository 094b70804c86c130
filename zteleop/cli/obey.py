"""The actuator proper: `zteleop actuator` starts it, and watches over it."""

import sys

import msgspec

from zteleop import config
from zteleop.bus.node import Node
from zteleop.config import Config
from zteleop.drivers import open_driver
from zteleop.nodes import link, realtime
from zteleop.nodes.actuator import Actuator
from zteleop.nodes.journal import Journal
from zteleop.nodes.stop_file import StopFile

PRIORITY, OOM_SCORE = 10, -800


def run(number: int) -> int:
    """Obey commands with the settings on stdin, under the watchdog at the other end of a socket."""
    settings = msgspec.json.decode(sys.stdin.buffer.read(), type=Config)
    robot = settings.robot or ""
    realtime.take(PRIORITY, OOM_SCORE)  # what is refused, the watchdog was refused as well, and says so
    with Node("actuator", robot, settings.bus) as node:
        folder = config.state_folder(robot)
        chip = settings.driver_settings(settings.driver, robot)
        Actuator(
            node,
            settings.drive,
            open_driver(settings.driver, chip, exclusive=False),
            link.adopt(number),
            StopFile(folder / "stop", node.log.error),
            Journal(folder, settings.journal, node.log.warn),
        ).run()
    return 0
