"""Options that every verb on the bus shares, and the robot they lead to."""

import argparse
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import msgspec

from zteleop import config
from zteleop.bus import presence
from zteleop.bus.escape import printable
from zteleop.bus.names import resolve, robot_name
from zteleop.bus.session import Session, open_session
from zteleop.cli._salvage import salvage
from zteleop.config import Config
from zteleop.control.vehicles import VEHICLES, made_into
from zteleop.errors import ConfigError
from zteleop.text.quantity import Dimension, quantity

if TYPE_CHECKING:
    from zteleop.bus.node import Node


def add(parser: argparse.ArgumentParser) -> None:
    """Add the options of a verb that joins the bus."""
    add_config(parser)
    parser.add_argument("--robot", metavar="NAME", type=_robot, help="the robot meant, such as archangel")
    parser.add_argument("-m", "--mode", choices=["peer", "client", "router"], help="how to join the bus")
    parser.add_argument(
        "-e",
        "--connect",
        metavar="ENDPOINT",
        action="append",
        help="join by this endpoint: tcp/pi.local:7447",
    )
    parser.add_argument(
        "-l", "--listen", metavar="ENDPOINT", action="append", help="be reachable at: tcp/[::]:7447"
    )
    parser.add_argument(
        "--no-multicast-scouting", action="store_true", help="do not look for others on the network"
    )


def add_robot(parser: argparse.ArgumentParser) -> None:
    """Add the robot as the first thing typed after the verb, besides --robot."""
    parser.add_argument("named", metavar="ROBOT", nargs="?", type=_robot, help="the robot, as with --robot")


def add_config(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "--config", metavar="FILE", type=Path, help="settings (default: ./config.toml, then the user's)"
    )


def load(options: argparse.Namespace, *, listens: bool = False) -> Config:
    """Return the settings of the file meant, with what was typed on top.

    `[bus] listen` is the robot's, which says `listens`: whoever else reads that file connects to it there.
    """
    settings = config.load(options.config)
    return with_typed(options, settings if listens else beside_robot(settings))


def load_anyhow(options: argparse.Namespace) -> Config:
    """Do the same, and where the file is not right go on with what can be read of it, and say so."""
    return with_typed(options, beside_robot(salvaged(options)[0]))


def beside_robot(settings: Config) -> Config:
    """Return the settings of a verb that runs on the machine of the robot whose file it reads."""
    bus = settings.bus
    if bus.mode == "router" or not bus.listen:
        return settings
    own = [re.sub(r"/(\[::\]|0\.0\.0\.0):", "/127.0.0.1:", endpoint) for endpoint in bus.listen]
    bus = msgspec.structs.replace(bus, listen=[], connect=bus.connect or own)
    return msgspec.structs.replace(settings, bus=bus)


def salvaged(options: argparse.Namespace) -> tuple[Config, bool]:
    """Return the settings of the file meant, as far as they can be read, and whether that is all of them.

    What is wrong is said; a stop must not fail for a typo.
    """
    settings, wrong = salvage(options.config)
    if wrong:
        rest = "" if wrong.startswith("cannot read") else "the rest of that file, and "
        words = f"zteleop: warning: {wrong}; goes on with {rest}what is built in"
        print(printable(words), file=sys.stderr)
    return settings, not wrong


def with_typed(options: argparse.Namespace, settings: Config) -> Config:
    """Return settings with what was typed on top."""
    typed = {
        "mode": options.mode,
        "connect": options.connect,
        "listen": options.listen,
        "multicast": False if options.no_multicast_scouting else None,
    }
    robot = getattr(options, "named", None) or options.robot or settings.robot
    bus = msgspec.structs.replace(settings.bus, **{k: v for k, v in typed.items() if v is not None})
    return msgspec.structs.replace(settings, bus=bus, robot=robot)


def find_robot(session: Session, settings: Config) -> str:
    """Return the robot meant: the one named, else the only one on the bus, else this machine's own.

    Raises ConfigError when there are several.
    """
    return settings.robot or heard_robot(session) or spoken_of(session) or own_robot(session)


def heard_robot(session: Session) -> str | None:
    """Return the only robot on the bus; None when there is none, ConfigError when there are several."""
    found = presence.robots(session)
    if len(found) > 1:
        raise ConfigError(f"{len(found)} robots are on the bus: {', '.join(found)}; say --robot NAME")
    return found[0] if found else None


def spoken_of(session: Session) -> str | None:
    """Return the only robot that nodes are here for, be its actuator off; None where there is no one such."""
    found = {node.robot for node in presence.nodes(session)}
    return found.pop() if len(found) == 1 else None


def own_robot(session: Session) -> str:
    """Return this machine's own robot's name, and say so: nobody has named it."""
    robot, others = config.own_name(), sorted({node.robot for node in presence.nodes(session)} - {""})
    heard = f"no actuator is heard (there are nodes of {', '.join(others)})" if others else "none is heard"
    words = f"zteleop: no robot is named, and {heard}; {robot} is meant, as this machine's own is called"
    print(printable(words), file=sys.stderr, flush=True)
    return robot


def robot_of(topic: str, settings: Config, typed: str | None = None) -> str | None:
    """Return the robot that a topic's name says, else the one selected, if any.

    Raises ConfigError where --robot was typed, and is another.
    """
    try:
        found = resolve(topic, settings.robot).robot
    except ConfigError:
        return settings.robot
    if typed not in (None, found):
        raise ConfigError(f"{topic} is a topic of {found}, and --robot says {typed}; leave one of them out")
    return found


def join(name: str, settings: Config, patient: bool = False, settle: bool = False) -> "Node":
    """Join the bus as a node of the robot meant; with `patient`, what is said waits for a full link.

    With `settle`, or without a robot's name, once everybody is found.
    """
    from zteleop.bus.node import Node  # not what only looks at the bus

    session = open_session(settings.bus, settle=settle or settings.robot is None, patient=patient)
    try:
        return Node(name, find_robot(session, settings), session=session)
    except BaseException:
        session.close()
        raise


def join_for_any(name: str, settings: Config, settle: bool) -> "Node":
    """Join the bus as a node of no robot; with `settle`, once everybody is found."""
    from zteleop.bus.node import Node

    return Node(name, session=open_session(settings.bus, settle=settle))


def count(text: str) -> int:
    """Return how often, as typed; at least once."""
    if not text.isdecimal() or int(text) < 1:
        raise argparse.ArgumentTypeError(f"at least once is meant, found {text}")
    return int(text)


def add_vehicle(parser: argparse.ArgumentParser) -> None:
    """Add the option that makes a robot without settings of its own another vehicle."""
    parser.add_argument(
        "--vehicle", choices=[*VEHICLES], help="what it drives (default: what config.toml says, else a car)"
    )


def with_vehicle(options: argparse.Namespace, settings: Config) -> Config:
    """Return settings with the vehicle that was typed; raises ConfigError where they make another."""
    if options.vehicle is None:
        return settings
    return msgspec.structs.replace(settings, drive=made_into(settings.drive, options.vehicle))


def place(text: str) -> float:
    """Return a coordinate as typed, such as -50cm, in m."""
    try:
        return quantity(text, "length")
    except ConfigError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def measure(dimension: Dimension) -> Callable[[str], float]:
    """Return what reads a measure as typed, such as 50cm, in SI units; more than nothing."""

    def read(text: str) -> float:
        try:
            found = quantity(text, dimension)
        except ConfigError as error:
            raise argparse.ArgumentTypeError(str(error)) from None
        if found <= 0:
            raise argparse.ArgumentTypeError(f"expected more than nothing, found {text.strip()}")
        return found

    return read


seconds = measure("time")


def rate_hz(text: str) -> float:
    """Return how often a second, as typed."""
    try:
        found = float(text)
    except ValueError:
        found = 0.0
    if not 0 < found <= 1000:
        raise argparse.ArgumentTypeError(f"a rate is more than 0 and at most 1000 Hz, found {text}")
    return found


def share(text: str) -> float:
    """Return a part of the whole, 0 to 1, as typed: 5% or 0.05."""
    try:
        found = float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
    except ValueError:
        found = -1.0
    if not 0 <= found <= 1:
        raise argparse.ArgumentTypeError(f"expected a share, such as 5% or 0.05, found {text}")
    return found


def _robot(text: str) -> str:
    try:
        return robot_name(text)
    except ConfigError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def add_parent(parser: argparse.ArgumentParser) -> None:
    """Add the option of a verb that another verb starts."""
    parser.add_argument("--with-parent", action="store_true", help=argparse.SUPPRESS)


def end_with_parent(options: argparse.Namespace, node: "Node") -> None:
    """End when stdin does: whoever started this process is gone, however it died."""
    if options.with_parent:
        node.membership.loop.watch(sys.stdin.fileno(), node.stop)
