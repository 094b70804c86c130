import argparse

import msgspec

from zteleop import config
from zteleop.bus import presence
from zteleop.bus.node import Node
from zteleop.bus.session import ROBOT_ENDPOINT, open_session
from zteleop.cli import options
from zteleop.config import Config
from zteleop.control.drive import DriveSettings
from zteleop.drivers import DRIVERS, open_driver
from zteleop.errors import ConfigError, DeviceError
from zteleop.nodes.actuator import Actuator


def add_arguments(parser: argparse.ArgumentParser) -> None:
    options.add(parser)
    parser.add_argument("--driver", choices=DRIVERS, help="the chip to write to (default: simulated)")
    parser.add_argument(
        "--pulse-duty",
        metavar="SHARE",
        type=float,
        help="obey the throttle for this share of the time, 0 to 1",
    )
    parser.add_argument(
        "--neutral-offset", metavar="TICKS", type=int, default=0, help="shift the throttle's neutral"
    )
    options.add_parent(parser)


def run(arguments: argparse.Namespace) -> None:
    settings = options.load(arguments)
    robot = settings.robot or config.own_name()
    bus = settings.bus
    if bus.mode == "peer" and bus.multicast and not bus.listen:
        bus = msgspec.structs.replace(bus, listen=[ROBOT_ENDPOINT, "tcp/[::]:0"])
    with open_session(bus, settle=True) as session:
        _only_one(presence.holders(session, robot, "actuator"), robot)
        with Node("actuator", robot, session=session) as node:
            options.end_with_parent(arguments, node)
            _yield_to_the_first(presence.holders(session, robot, "actuator"), robot)
            name = arguments.driver or settings.driver
            driver = open_driver(name, settings.driver_settings(name, robot))
            Actuator(node, _tuned(settings, arguments, driver.tick_us), driver).run()


def _tuned(settings: Config, arguments: argparse.Namespace, tick_us: float) -> DriveSettings:
    """Return the drive with what was typed on top."""
    values = msgspec.to_builtins(settings.drive)
    if arguments.pulse_duty is not None:
        values["limits"]["pulse_duty"] = arguments.pulse_duty
    if arguments.neutral_offset and "throttle" not in values["servos"]:
        raise ConfigError("--neutral-offset shifts the throttle's neutral, and this vehicle has no throttle")
    if arguments.neutral_offset:
        values["servos"]["throttle"]["neutral_us"] += arguments.neutral_offset * tick_us
    try:
        return msgspec.convert(values, DriveSettings)
    except msgspec.ValidationError as error:
        raise ConfigError(f"{error}") from None


def _only_one(holders: list[str], robot: str) -> None:
    if holders:
        raise DeviceError(
            f"robot {robot} has an actuator already: {', '.join(holders)}; stop it, or say --robot"
        )


def _yield_to_the_first(holders: list[str], robot: str) -> None:
    """Of two that start at once, one goes on."""
    _only_one([holder for holder in holders if holder < presence.process()], robot)
