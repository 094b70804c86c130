"""Where stops are said and heard: the ports of the bus, and a group on each interface."""

import re
import socket
import struct
import sys
from collections.abc import Iterable
from contextlib import suppress
from typing import NamedTuple

from zteleop.bus.settings import PORT

GROUP, GROUP_PORT = "239.255.74.47", PORT + 1
"""of the organisation-local scope (RFC 2365); no router passes it on, as its time to live is 1;
a port of its own, as several share it and nobody shares that of the bus"""
_PLACE = re.compile(r"\w[\w-]*/(\[[^\]]+\]|[^\s/:\[\]?#]+):(\d{1,5})")
_ANY = socket.inet_aton("0.0.0.0")


class Place(NamedTuple):
    """A host, by name or number, and a port."""

    host: str
    port: int


def places(endpoints: Iterable[str]) -> list[Place]:
    """Return the places of endpoints such as tcp/[::]:7447, those of other kinds and port 0 left out."""
    found = (_PLACE.match(endpoint) for endpoint in endpoints)
    return [Place(match[1].strip("[]"), int(match[2])) for match in found if match and int(match[2])]


def interfaces() -> list[int]:
    """Return the numbers of this machine's network interfaces."""
    with suppress(OSError):
        return [number for number, _ in socket.if_nameindex()]
    return []


def loopback() -> int | None:
    """Return the number of the interface that leaves this machine alone."""
    for name in ("lo", "lo0"):
        with suppress(OSError):
            return socket.if_nametoindex(name)
    return None


def hear_at(place: Place) -> socket.socket:
    """Return a socket that hears what is sent to a place; raises OSError when it cannot, or another does.

    A place is meant by number: a name may take seconds to become one, and a watchdog asks.
    """
    flags = socket.AI_PASSIVE | socket.AI_NUMERICHOST
    found = socket.getaddrinfo(place.host, place.port, type=socket.SOCK_DGRAM, flags=flags)
    kind, *_, address = found[0]
    ear = socket.socket(kind, socket.SOCK_DGRAM)
    try:
        if kind == socket.AF_INET6:
            ear.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 0)
        ear.setblocking(False)
        ear.bind(address)
    except BaseException:
        ear.close()
        raise
    return ear


def hear_group() -> socket.socket:
    """Return a socket that hears the group, as soon as it has joined it; it shares the port with others."""
    ear = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        ear.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if sys.platform == "darwin":  # where the first option does not share a port
            ear.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEPORT, 1)
        ear.setblocking(False)
        ear.bind((GROUP, GROUP_PORT))
    except BaseException:
        ear.close()
        raise
    return ear


def join_group(ear: socket.socket) -> None:
    """Join the group on every interface there is now; those that it has joined already say so."""
    for number in interfaces():
        with suppress(OSError):
            ear.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, _mreqn(GROUP, number))


def send_to_group(mouth: socket.socket, data: bytes, numbers: Iterable[int]) -> None:
    """Send to the group on some interfaces."""
    for number in numbers:
        with suppress(OSError):  # one that is down, or has no address
            mouth.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, _mreqn("0.0.0.0", number))
            mouth.sendto(data, (GROUP, GROUP_PORT))


def _mreqn(group: str, interface: int) -> bytes:
    """Return struct ip_mreqn of ip(7)."""
    return struct.pack("4s4si", socket.inet_aton(group), _ANY, interface)
