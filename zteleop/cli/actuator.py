import argparse

import msgspec

from zteleop import config
from zteleop.bus.node import Node
from zteleop.cli import _options
from zteleop.config import Config
from zteleop.control.calibration import check_pulses
from zteleop.control.settings import DriveSettings
from zteleop.drivers import DRIVERS, open_driver
from zteleop.drivers.registers import longest_us
from zteleop.errors import ConfigError
from zteleop.machine.changes import Changes
from zteleop.processes import watchdog

EXAMPLES = (
    "zteleop actuator",
    "zteleop actuator --robot archangel --journal all",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    _options.add_vehicle(parser)
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
    parser.add_argument(
        "--journal",
        choices=["acts", "all", "off"],
        help="what to keep of the commands on disk: who acted (default), every one, nothing",
    )
    _options.add_parent(parser)


def run(arguments: argparse.Namespace) -> int:
    """Watch over a robot until told to end."""
    file = arguments.config or config.found()
    changes = Changes(file) if file else None
    settings = _options.with_vehicle(arguments, _options.load(arguments, listens=True))
    robot = settings.robot or config.own_name()
    name = arguments.driver or settings.driver
    chip = settings.driver_settings(name, robot)
    hand = open_driver(name, chip)
    drive = _tuned(settings, arguments, hand.tick_us)
    check_pulses(drive.servos, longest_us(hand.tick_us))
    tuned = msgspec.structs.replace(
        settings,
        robot=robot,
        driver=name,
        drive=drive,
        journal=arguments.journal or settings.journal,
    )
    return watchdog.run(tuned, hand, lambda node: _joined(arguments, node, changes))


def _joined(arguments: argparse.Namespace, node: Node, changes: Changes | None) -> None:
    _options.end_with_parent(arguments, node)
    if changes:
        loop, log = node.membership.loop, node.log
        changes.watch(lambda words: loop.call_soon(lambda: log.warn(words)))


def _tuned(settings: Config, arguments: argparse.Namespace, tick_us: float) -> DriveSettings:
    """Return the drive with what was typed on top."""
    values = msgspec.to_builtins(settings.drive)
    if arguments.pulse_duty is not None:
        values["limits"]["pulse_duty"] = arguments.pulse_duty
    if arguments.neutral_offset and "throttle" not in values["servos"]:
        raise ConfigError("--neutral-offset shifts the throttle's neutral, and this vehicle has no throttle")
    try:
        if arguments.neutral_offset:
            values["servos"]["throttle"]["neutral_us"] += arguments.neutral_offset * tick_us
        return msgspec.convert(values, DriveSettings)
    except (msgspec.ValidationError, OverflowError) as error:
        raise ConfigError(f"{error}") from None
