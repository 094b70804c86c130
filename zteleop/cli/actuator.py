import argparse
import sys
import tempfile
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager

import msgspec

from zteleop import config
from zteleop.bus import presence
from zteleop.bus.lane.ear import Ear
from zteleop.bus.node import Node
from zteleop.bus.session import ROBOT_ENDPOINT, BusSettings, open_session
from zteleop.cli import options
from zteleop.config import Config
from zteleop.control.drive import DriveSettings
from zteleop.drivers import DRIVERS, open_driver, output_enable
from zteleop.drivers.output_enable import OutputEnable
from zteleop.errors import ConfigError, DeviceError
from zteleop.messages import WatchdogStatus
from zteleop.nodes import realtime
from zteleop.nodes.child import Child
from zteleop.nodes.recorder import Recorder
from zteleop.nodes.stop_file import StopFile
from zteleop.nodes.watchdog import Watchdog

LARGEST = 2**20
"""bytes of a message that passes a robot's door: whoever sends more would hold up the commands of others."""
LONGEST_PLACE = 70
"""characters of a folder for the private socket, whose whole path may have a hundred"""
PRIORITY, OOM_SCORE = 20, -900
SPEAKS_WITHIN = 1.0
"""s; a watchdog says five times a second what it sees"""
CHILD = [sys.executable, "-m", "zteleop", "actuator"]
RECORDER = [*CHILD, "--record"]


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
    parser.add_argument(
        "--journal",
        choices=["acts", "all", "off"],
        help="what to keep of the commands on disk: who acted (default), every one, nothing",
    )
    parser.add_argument("--link", type=int, help=argparse.SUPPRESS)
    parser.add_argument("--record", action="store_true", help=argparse.SUPPRESS)
    options.add_parent(parser)


def run(arguments: argparse.Namespace) -> int:
    """Watch over an actuator, or with --link be the one that is watched, with --record its black box."""
    if arguments.link is not None:
        from zteleop.cli import obey  # what the watchdog itself need not hold in memory

        return obey.run(arguments.link)
    if arguments.record:
        from zteleop.cli import record

        return record.run()
    settings = options.load(arguments)
    robot = settings.robot or config.own_name()
    name = arguments.driver or settings.driver
    chip = settings.driver_settings(name, robot)
    hand = open_driver(name, chip)
    tuned = msgspec.structs.replace(
        settings,
        robot=robot,
        driver=name,
        drive=_tuned(settings, arguments, hand.tick_us),
        journal=arguments.journal or settings.journal,
    )
    with ExitStack() as stack:
        place = None if len(tempfile.gettempdir()) < LONGEST_PLACE else "/tmp"
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix="zteleop-", dir=place))
        bus, childs_bus = _door(tuned.bus, f"unixsock-stream/{folder}/bus")
        with realtime.lent(PRIORITY):
            node = stack.enter_context(_join(robot, bus))
        options.end_with_parent(arguments, node)
        pin = output_enable(name, chip)
        if pin:
            stack.callback(pin.close)
        _privileges(node)
        orders = msgspec.json.encode(msgspec.structs.replace(tuned, bus=childs_bus))
        child = Child(CHILD, orders, hand.shared())
        recorder = Recorder(RECORDER, orders, node.log.warn) if tuned.blackbox else None
        stop_file = StopFile(config.state_folder(robot) / "stop", node.log.error)
        lane = stack.enter_context(closing(Ear(robot, bus, node.log.warn)))
        return Watchdog(node, tuned.drive, hand, child, stop_file, _switch(node, pin), recorder, lane).run()


@contextmanager
def _join(robot: str, bus: BusSettings) -> Iterator[Node]:
    """Join the bus as the only watchdog of that robot."""
    with open_session(bus, settle=True, door=True) as session:
        before = presence.holders(session, robot, "watchdog")
        with Node("watchdog", robot, session=session, feed=realtime.feed) as node:
            holders = {*before, *_who_goes_first(presence.holders(session, robot, "watchdog"))}
            if holders:
                _pass_over(node, ", ".join(sorted(holders)))
            yield node


def _who_goes_first(holders: list[str]) -> list[str]:
    """Of several that start at once, one goes on."""
    return [holder for holder in holders if holder < presence.process()]


def _pass_over(node: Node, holders: str) -> None:
    """Take a place whose holders say nothing: anybody may hold one, and only a watchdog speaks.

    Raises DeviceError when one does.
    """
    statuses = node.subscription("watchdog", WatchdogStatus)
    if node.until(statuses.newest, SPEAKS_WITHIN):
        raise DeviceError(f"robot {node.robot} has an actuator already: {holders}; stop it, or say --robot")
    node.log.warn(f"{holders} holds the place of this robot's watchdog and says nothing; it is passed over")


def _switch(node: Node, pin: OutputEnable | None) -> Callable[[bool], bool]:
    """Return what lets the chip's outputs through, or cuts them, and says whether a pin did."""

    def switch(on: bool) -> bool:
        try:
            if pin:
                pin.enable() if on else pin.disable()
        except DeviceError as error:
            node.log.error(str(error), "oe")
            return False
        return pin is not None

    return switch


def _door(bus: BusSettings, private: str) -> tuple[BusSettings, BusSettings]:
    """Return how the watchdog joins the bus, and how its actuator does: through the watchdog's door."""
    if bus.mode == "client":
        return bus, bus
    listen = bus.listen
    if bus.mode == "peer" and bus.multicast and not listen:
        listen = [ROBOT_ENDPOINT, "tcp/[::]:0"]
    childs = BusSettings(mode="client", connect=[private], multicast=False, largest=LARGEST)
    return msgspec.structs.replace(bus, listen=[*listen, private], largest=LARGEST), childs


def _privileges(node: Node) -> None:
    missing = realtime.take(PRIORITY, OOM_SCORE)
    if missing:
        node.log.info(f"runs without {', '.join(missing)}: not permitted; deploy/README.md says how")


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
