import argparse
from collections.abc import Iterator
from contextlib import contextmanager

import msgspec

from zteleop import config
from zteleop.bus import clock, presence
from zteleop.bus.node import Node
from zteleop.bus.session import Session, open_session
from zteleop.cli import _bad_link, _options, _scenes
from zteleop.cli._alone import expect_alone
from zteleop.config import Config
from zteleop.control.report import to_vehicle
from zteleop.control.vehicles import VEHICLES, name_of
from zteleop.errors import DeviceError
from zteleop.messages import Odometry, Vehicle
from zteleop.nodes import simulator
from zteleop.nodes.simulator import Simulated
from zteleop.sim.noise import LEVELS

EXAMPLES = (
    "zteleop sim",
    "zteleop sim tank --robot archangel --scene maze",
)
SPEAKS_WITHIN = 1.0
"""s in which another one is heard, if it moves the same robot"""
TELL_AFTER = 1.0
"""s until it says that nobody moves it"""
ROUNDED = 1.01
OTHER_CHIP = (
    'these settings say driver = "{driver}": an actuator with them moves that chip, and nothing here; '
    "start zteleop actuator --driver simulated --robot {robot}"
)
LOST_AFTER = 1.0
"""s without a beat, of twenty a second, after which nobody does any more"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument(
        "vehicle",
        nargs="?",
        choices=[*VEHICLES],
        help="what to simulate (default: what config.toml says, else a car)",
    )
    parser.add_argument(
        "--scene", metavar="NAME", help=f"where it drives: {', '.join(_scenes.names())}, or a file"
    )
    parser.add_argument(
        "--noise",
        choices=[*LEVELS],
        default="none",
        help="how wrong its odometry and its range are (default: none)",
    )
    parser.add_argument("--seed", metavar="N", type=int, default=0, help="of noise, --loss and --unknown")
    parser.add_argument(
        "--unknown",
        action="store_true",
        help="a car whose servo and motor are not what config.toml says: find out with zteleop calibrate",
    )
    parser.add_argument(
        "--camera", action="store_true", help="say what it sees ahead, on camera/image/compressed"
    )
    parser.add_argument(
        "--charge", metavar="SHARE", type=_options.share, default=1.0, help="of its battery (default: 100%%)"
    )
    _bad_link.add(parser, "what it says")
    _options.add_parent(parser)


def run(arguments: argparse.Namespace) -> None:
    settings = _options.with_vehicle(arguments, _options.load(arguments))
    scene = _scenes.find(arguments.scene) if arguments.scene else None
    session = open_session(settings.bus, settle=True)
    with _join(_robot_of(settings, session), session) as node:
        expect_alone(node)
        _bad_link.worsen(node, arguments, arguments.seed)
        robot = node.robot or ""
        kind = arguments.vehicle or name_of(settings.drive)
        driver = settings.driver_settings("simulated", robot)
        _options.end_with_parent(arguments, node)
        node.log.info(f"moves {robot}, a simulated {kind}, by the pulses in {driver['path']}")
        if settings.driver != "simulated":
            node.log.warn(OTHER_CHIP.format(driver=settings.driver, robot=robot))
        unlimited = msgspec.structs.replace(settings.drive, limits=VEHICLES[kind].limits)
        node.every(TELL_AFTER)(Attendant(node, kind, to_vehicle(unlimited, 1.0), arguments.unknown).look)
        simulated = Simulated(
            kind,
            scene,
            LEVELS[arguments.noise],
            arguments.seed,
            arguments.unknown,
            arguments.camera,
            arguments.charge,
        )
        simulator.run(node, settings.drive, driver["path"], lambda line: print(line, flush=True), simulated)


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


def _robot_of(settings: Config, session: Session) -> str:
    """Return the robot to move: the one named, else the only one on the bus, else this machine's own."""
    try:
        return settings.robot or _options.heard_robot(session) or config.own_name()
    except BaseException:
        session.close()
        raise


class Attendant:
    """Says whether anybody moves the car: its actuator comes and goes as it likes."""

    def __init__(self, node: Node, kind: str, own: Vehicle, unknown: bool = False) -> None:
        self._node = node
        self._kind = kind
        self._own = own
        self._unknown = unknown
        self._differs = ""
        self._heard = node.membership.heard()
        self._there: bool | None = None
        self._began = clock.now()

    def look(self) -> None:
        """Say what has changed since the last look."""
        now = clock.now()
        there = self._heard.beat is not None and now - self._heard.at < LOST_AFTER
        self._compare(self._heard.vehicle if there else None)
        if there == self._there or (self._there is None and not there and now - self._began < TELL_AFTER):
            return
        was, self._there = self._there, there
        robot = self._node.robot or ""
        if there:
            self._node.log.info(f"the actuator of {robot} is heard, and moves it")
        elif was:
            self._node.log.warn(f"the actuator of {robot} is not heard any more; its chip stays as it is")
        else:
            here = presence.here(self._node.membership.session, robot)
            verb = "calibrate" if self._unknown else "actuator"
            start = f"start zteleop {verb} --robot {robot}"
            self._node.log.warn(f"waits for pulses: no actuator of {robot} is heard ({here}); {start}")

    def _compare(self, vehicle: Vehicle | None) -> None:
        """Say so where its actuator drives another vehicle: its pulses mean something else here."""
        differs = difference(vehicle, self._own) if vehicle else ""
        if differs and differs != self._differs:
            words = f"the actuator of {self._node.robot} drives another vehicle than this {self._kind}"
            self._node.log.warn(f"{words}, and its pulses mean something else: {differs}")
        self._differs = differs


def difference(there: Vehicle, here: Vehicle) -> str:
    """Return how one vehicle can not be the other; nothing where it may be, slowed down by its limits."""
    if there.steers != here.steers:
        does = {True: "steers", False: "turns by its wheels"}
        return f"that one {does[there.steers]}, and this one {does[here.steers]}"
    if there.max_speed <= ROUNDED * here.max_speed and there.max_turn <= ROUNDED * here.max_turn:
        return ""
    return (
        f"at most {there.max_speed:.3g} m/s and {there.max_turn:.3g} rad/s there, "
        f"{here.max_speed:.3g} m/s and {here.max_turn:.3g} rad/s here"
    )
