import argparse
import sys
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from zteleop.bus import clock, presence
from zteleop.bus.escape import printable
from zteleop.bus.node import Node
from zteleop.bus.subscription import Received
from zteleop.cli import _options
from zteleop.control.proof import called
from zteleop.errors import BusError
from zteleop.messages import DriveStatus, GetTimeRequest, GetTimeResponse, Hop, Latency
from zteleop.nodes.times import ACT_TO_BUS, ACTUATOR_TO_CHIP, DOOR_TO_ACTUATOR, ROBOT

EXAMPLES = (
    "zteleop latency",
    "zteleop latency archangel --once",
)
LINE_EVERY = 1.0
ASK_EVERY = 0.1
ANSWERED_WITHIN = 0.5
HEARD_WITHIN = 2.0
TOLD_FOR = 1.5
"""s for which what a process told of its last second is shown"""
NETWORK = "network"
PARTS = (ACT_TO_BUS, NETWORK, DOOR_TO_ACTUATOR, ACTUATOR_TO_CHIP)
"""of the way, in the order in which they are passed"""
HEAD = (*PARTS, "in all", "at worst")
NOBODY = "nobody drives"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    _options.add_robot(parser)
    parser.add_argument("--once", action="store_true", help="print one line and end")


def run(arguments: argparse.Namespace) -> None:
    """Print a line a second: how long commands took on each part of their way."""
    with _options.join("latency", _options.load_anyhow(arguments)) as node:
        way = Way(node)
        node.subscription("drive_status", DriveStatus, way.see)
        node.subscription("latency", Latency, way.hear)
        node.every(ASK_EVERY)(way.ask)

        def tell() -> None:
            due.ring_at(clock.now() + LINE_EVERY)
            if not way.is_heard:  # which soon is an error
                return
            print(printable(_row(way.driver, way.cells())), flush=True)
            if arguments.once:
                node.stop()

        due = node.membership.loop.alarm(tell)
        due.ring_at(clock.now() + LINE_EVERY)
        print(printable(_row(f"{way.robot}, ms", HEAD)), flush=True)
        if sys.stderr.isatty() and not arguments.once:
            print("ms, medians of a second; Ctrl-C ends this, and nothing of the robot", file=sys.stderr)
        node.spin()


class Told(NamedTuple):
    """What a process said last of the commands that passed through it, and when."""

    hops: Sequence[Hop] = ()
    at: float = 0.0


class Way:
    """From an operator's act to the chip of one robot."""

    def __init__(self, node: Node) -> None:
        self.robot = node.robot or ""
        self._node = node
        self._told: dict[str, Told] = {}
        self._there: list[float] = []
        """s, of each question since the last line: half of there and back"""
        self.driver = NOBODY
        """who, by the name that everything calls it"""
        self.is_heard = False
        """the robot has said anything at all"""
        self._heard = clock.now()

    def see(self, received: Received[DriveStatus]) -> None:
        status = received.message
        self.driver = called(status.source, status.operator) if status.operator else NOBODY
        self._heard, self.is_heard = received.at, True

    def hear(self, received: Received[Latency]) -> None:
        self._told[received.message.by] = Told(received.message.hops, received.at)

    def ask(self) -> None:
        """Ask the robot something, and note how long that took; raises BusError when it is not heard."""
        before = clock.now()
        try:
            self._node.call(
                f"/{self.robot}/actuator/get_time", GetTimeRequest(), GetTimeResponse, ANSWERED_WITHIN
            )
        except BusError:
            if clock.now() - self._heard > HEARD_WITHIN:
                here = presence.here(self._node.membership.session, self.robot)
                raise BusError(
                    f"no actuator of {self.robot} is heard within {HEARD_WITHIN:g} s; is it on? {here}"
                ) from None
        else:
            self._there.append((clock.now() - before) / 2)
            self._heard, self.is_heard = clock.now(), True

    def cells(self) -> tuple[str, ...]:
        """Return how long each part took in the last second, all of it, and how long at the worst."""
        hops = {hop.name: hop for hop in self._hops()}
        if there := self._network(hops.get(DOOR_TO_ACTUATOR)):
            hops[NETWORK] = there
        parts = [hops.get(part) for part in PARTS]
        known = [hop for hop in parts if hop]
        cells = [_ms(hop.median) if hop else "-" for hop in parts]
        if not all(parts[1:]):  # of a program nobody knows when it acted
            return (*cells, "-", "-")
        return (*cells, _ms(sum(hop.median for hop in known)), _ms(sum(hop.worst for hop in known)))

    def _network(self, door: Hop | None) -> Hop | None:
        """Return how long it is to the robot's door: what is behind it a question passes as well."""
        there, self._there = sorted(self._there), []
        if not there:
            return None
        behind = door.median if door else 0.0
        return Hop(NETWORK, len(there), max(there[len(there) // 2] - behind, 0.0), there[-1])

    def _hops(self) -> Iterator[Hop]:
        """Yield those of the last second, of whoever drives and of the robot."""
        for by in (self.driver, ROBOT):
            told = self._told.get(by, Told())
            if self.driver != NOBODY and clock.now() - told.at < TOLD_FOR:
                yield from told.hops


def _ms(seconds: float) -> str:
    return f"{seconds * 1000:.2f}"


def _row(name: str, cells: Sequence[str]) -> str:
    width = max(map(len, HEAD))
    return f"{name:16}" + "".join(f"  {cell:>{width}}" for cell in cells)
