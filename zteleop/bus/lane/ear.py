"""A robot's end of the lane: hears stops, and answers; a flood costs it a few milliseconds a second."""

import errno
import socket
from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import NamedTuple

from zteleop.bus.lane import places, wire
from zteleop.bus.lane.places import Place
from zteleop.bus.lane.wire import Answered, Asked
from zteleop.bus.settings import BusSettings
from zteleop.control.allowance import Allowance

READ, OF_ONE = 64, 8
"""datagrams looked at each time, and of one sender; the rest of what he says is thrown away unread"""
KNOWN = 256
"""stops, and senders, that are remembered"""
STOPS_OF_ONE, STOPS_IN_ALL = (5, 2.0), (20, 5.0)
"""new stops at once, and s until there may be one more: each is written to a disk"""
TEND_EVERY = 5.0
"""s; an interface may come later than the robot, and another robot give its port back"""

Address = tuple[str, int]


class Heard(NamedTuple):
    """A stop that was asked for, and where the answer goes."""

    asked: Asked
    address: Address
    at: socket.socket

    def answer(self, answer: Answered) -> None:
        """Say how the robot stands to whoever asked; what the network does not take is lost."""
        with suppress(OSError):
            self.at.sendto(wire.pack(answer), self.address)


class Ear:
    """Hears what asks one robot to stop, at the places of its bus."""

    def __init__(self, robot: str, bus: BusSettings, complain: Callable[[str], object]) -> None:
        self._robot = robot
        self._complain = complain
        self._direct: dict[Place, socket.socket] = {}
        self._places = places.places(bus.listen) if bus.stop_lane else []
        self._group = _open_group(complain) if bus.stop_lane and bus.multicast else None
        self._mouth = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._mouth.setblocking(False)
        self._tend_at = float("-inf")
        self._known: OrderedDict[int, None] = OrderedDict()
        self._in_all = Allowance(*STOPS_IN_ALL)
        self._of_one: OrderedDict[str, Allowance] = OrderedDict()
        self._tend()

    def close(self) -> None:
        for ear in (*self._direct.values(), self._mouth, *([self._group] if self._group else [])):
            ear.close()

    def take(self, now: float) -> Iterator[Heard]:
        """Yield the stops that were asked of this robot, without waiting; each is to be answered."""
        if now >= self._tend_at:
            self._tend_at = now + TEND_EVERY
            self._tend()
        for ear in self._direct.values():
            for data, address in _read(ear):
                yield from self._hear(data, address, ear, now)
        for data, address in _read(self._group) if self._group else ():
            yield from self._hear(data, address, self._mouth, now)

    def _tend(self) -> None:
        """Join the group where there is a new interface, and take the ports that are free now."""
        if self._group:
            places.join_group(self._group)
        for place in list(self._places):
            if place not in self._direct:
                self._try(place)

    def _try(self, place: Place) -> None:
        try:
            self._direct[place] = places.hear_at(place)
        except (OSError, UnicodeError) as error:
            if getattr(error, "errno", None) != errno.EADDRINUSE:  # else another robot has it, and passes on
                self._places.remove(place)
                why = getattr(error, "strerror", None) or error
                self._complain(f"hears no stops on {place.host}:{place.port}/udp: {why}")

    def _hear(self, data: bytes, address: Address, at: socket.socket, now: float) -> Iterator[Heard]:
        asked = wire.unpack_asked(data)
        if asked is None:
            return
        if asked.robot != self._robot:
            self._pass_on(asked, address, at)
        elif self._admits(asked, address, now):
            passed_on = asked.answer_to if at is self._mouth else None
            yield Heard(asked, passed_on or address, at)

    def _pass_on(self, asked: Asked, address: Address, at: socket.socket) -> None:
        """Hand what was sent here for another robot of this machine to the group; never what came by it."""
        if self._group and at is not self._mouth and asked.answer_to is None:
            host = address[0].removeprefix("::ffff:")
            passed = Asked(asked.robot, asked.id, asked.by, asked.why, (host, address[1]))
            inside = places.loopback()
            places.send_to_group(self._mouth, wire.pack(passed), [] if inside is None else [inside])

    def _admits(self, asked: Asked, address: Address, now: float) -> bool:
        """Say whether a stop is known, or one more may be engaged; who repeats it is heard in the end."""
        if asked.id in self._known:
            return True
        whose = self._of_one.setdefault(address[0], Allowance(*STOPS_OF_ONE))
        self._of_one.move_to_end(address[0])
        if len(self._of_one) > KNOWN:
            self._of_one.popitem(last=False)
        if not (whose.has(now) and self._in_all.has(now)):
            return False
        whose.spend(now)
        self._in_all.spend(now)
        self._known[asked.id] = None
        if len(self._known) > KNOWN:
            self._known.popitem(last=False)
        return True


def _open_group(complain: Callable[[str], object]) -> socket.socket | None:
    try:
        return places.hear_group()
    except OSError as error:
        complain(f"hears no stops by multicast: {error.strerror or error}")
        return None


def _read(ear: socket.socket) -> Iterator[tuple[bytes, Address]]:
    """Yield what has arrived, of each sender at most a few."""
    said: dict[str, int] = {}
    for _ in range(READ):
        try:
            data, (host, port, *_) = ear.recvfrom(wire.LONGEST + 1)
        except OSError:  # nothing more; or the network's answer to an answer
            return
        said[host] = said.get(host, 0) + 1
        if said[host] <= OF_ONE and len(data) <= wire.LONGEST:
            yield data, (host, port)
