import argparse
from collections.abc import Iterator
from contextlib import contextmanager

from zteleop import config
from zteleop.bus import clock, presence
from zteleop.bus.node import Node
from zteleop.bus.session import Session, open_session
from zteleop.cli import _options
from zteleop.errors import DeviceError
from zteleop.messages import Odometry
from zteleop.nodes import simulator

EXAMPLES = (
    "zteleop sim",
    "zteleop sim car --robot archangel",
)
SPEAKS_WITHIN = 1.0
"""s in which another one is heard, if it moves the same robot"""
TELL_AFTER = 1.0
"""s until it says that nobody moves it"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("vehicle", nargs="?", choices=["car"], default="car", help="what to simulate")
    _options.add_parent(parser)


def run(arguments: argparse.Namespace) -> None:
    settings = _options.load(arguments)
    robot = settings.robot or config.own_name()
    driver = settings.driver_settings("simulated", robot)
    with _join(robot, open_session(settings.bus, settle=True)) as node:
        _options.end_with_parent(arguments, node)
        node.log.info(f"moves {robot}, a simulated {arguments.vehicle}, by the pulses in {driver['path']}")
        node.membership.loop.alarm(lambda: _miss_actuator(node, robot)).ring_at(clock.now() + TELL_AFTER)
        simulator.run(node, settings.drive, driver["path"], lambda line: print(line, flush=True))


@contextmanager
def _join(robot: str, session: Session) -> Iterator[Node]:
    """Join the bus as the only one that simulates a robot; raises DeviceError when another does."""
    before = presence.holders(session, robot, "sim")
    with Node("sim", robot, session=session) as node:
        odoms = node.subscription("odom", Odometry)
        others = presence.rivals(session, robot, "sim", before)
        speaks = node.membership.until(odoms.newest, SPEAKS_WITHIN) if others else None
        if speaks:
            raise DeviceError(
                f"robot {robot} is simulated already, by {', '.join(others)}; end that, or say --robot NAME"
            )
        yield node


def _miss_actuator(node: Node, robot: str) -> None:
    if not presence.holders(node.membership.session, robot, "actuator"):
        node.log.warn(f"waits for pulses: no actuator is heard; start zteleop actuator --robot {robot}")
