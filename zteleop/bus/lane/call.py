"""The other end of the lane: whoever stops a robot without asking zenoh."""

import socket
import threading
from collections.abc import Iterator
from contextlib import suppress
from typing import Self

from zteleop.bus.lane import places, wire
from zteleop.bus.lane.places import Place
from zteleop.bus.lane.wire import Answered, Asked
from zteleop.bus.settings import SAME_MACHINE, BusSettings
from zteleop.machine import signals
from zteleop.messages import Stop

_MOST = 100
"""answers taken at once"""


class Call:
    """Says stops to where robots hear them, as often as it is asked to, and takes their answers."""

    def __init__(self, bus: BusSettings) -> None:
        self._multicast = bus.multicast and bus.stop_lane
        wanted = places.places(bus.connect or [SAME_MACHINE]) if bus.stop_lane else []
        self._mouths: dict[int, socket.socket] = {}
        self._addresses: list[tuple[int, tuple[str, int]]] = []
        for kind in (socket.AF_INET, socket.AF_INET6):
            with suppress(OSError):  # a machine without one of them
                self._mouths[kind] = socket.socket(kind, socket.SOCK_DGRAM)
                self._mouths[kind].setblocking(False)
        # A name may take seconds to become an address, and a stop does not wait for it.
        signals.start(threading.Thread(target=self._find, args=(wanted,), name="stop lane", daemon=True))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        for mouth in self._mouths.values():
            mouth.close()

    def say(self, robot: str, stop: Stop) -> None:
        """Say a stop once, wherever it may be heard; what no network takes is lost."""
        if not stop.engaged:
            return
        data = wire.pack(Asked(robot, stop.id, stop.by, stop.why))
        for kind, address in list(self._addresses):
            with suppress(OSError, KeyError):
                self._mouths[kind].sendto(data, address)
        if self._multicast and socket.AF_INET in self._mouths:
            places.send_to_group(self._mouths[socket.AF_INET], data, places.interfaces())

    def answers(self) -> Iterator[Answered]:
        """Yield what robots have answered, without waiting."""
        for mouth in self._mouths.values():
            for _ in range(_MOST):
                try:
                    data = mouth.recv(wire.LONGEST)
                except BlockingIOError:
                    break
                except OSError:  # nobody hears at one of the places
                    continue
                if answer := wire.unpack_answered(data):
                    yield answer

    def _find(self, wanted: list[Place]) -> None:
        for host, port in wanted:
            with suppress(OSError, UnicodeError):
                for kind, *_, address in socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM):
                    self._addresses.append((kind, (str(address[0]), port)))
