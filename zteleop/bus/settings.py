"""How to join the bus, as config.toml says it; zenoh is not needed to read it."""

from typing import Annotated, Literal

from msgspec import Meta, Struct

PORT = 7447
IF_FREE = "#exit_on_failure=false"
"""After an endpoint to listen on: when another has it, go on without."""
ROBOT_ENDPOINT = f"tcp/[::]:{PORT}{IF_FREE}"
ANY_PORT = "tcp/[::]:0"
"""where everybody listens who is told of no other place"""
BEHIND = "door/"
"""Before the place of a robot's door: an endpoint of the robot's own processes."""
SAME_MACHINE = f"tcp/127.0.0.1:{PORT}"
SAME_MACHINE_DOOR = f"{SAME_MACHINE}{IF_FREE}"


_HOST = r"(\[[0-9A-Fa-f:.%]+\]|[^\s/:\[\]]+)"
ENDPOINT = rf"^((tcp|udp|tls|quic|ws)/{_HOST}:\d{{1,5}}([?#].*)?$|unixsock-stream/.|{BEHIND}.)"
_SUCH_AS = f"an endpoint such as tcp/pi.local:{PORT} or tcp/[::]:{PORT}"
Endpoint = Annotated[str, Meta(pattern=ENDPOINT, description=_SUCH_AS)]


class BusSettings(Struct, frozen=True, forbid_unknown_fields=True):
    """How to join the bus. On an open LAN: peers that find each other, in any order."""

    mode: Literal["peer", "client", "router"] = "peer"
    connect: list[Endpoint] = []
    """endpoints such as tcp/pi.local:7447, besides what multicast finds"""
    listen: list[Endpoint] = []
    multicast: bool = True
    patience: Annotated[float, Meta(ge=0, le=3600)] = 3.0
    """s a client waits for its router"""
    largest: Annotated[int, Meta(ge=65536, le=2**30)] = 2**28
    """bytes of a message; a longer one is dropped on its way in"""
    stop_lane: bool = True
    """stops are said and heard as datagrams too, for when zenoh is not"""
