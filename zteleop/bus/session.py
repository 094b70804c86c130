"""Open zenoh from settings: the one place that knows zenoh's configuration."""

import json
import os
import re
import time
from typing import Annotated, Literal

from msgspec import Meta, Struct

from zteleop.errors import BusError, ConfigError

# One thread halves the latency of an idle link; zenoh reads this when it is imported.
os.environ.setdefault(
    "ZENOH_RUNTIME",
    "(rx:(handover:app),acc:(handover:app),tx:(handover:app),net:(handover:app),app:(worker_threads:1))",
)

import zenoh

PORT = 7447
ROBOT_ENDPOINT = f"tcp/[::]:{PORT}"
SAME_MACHINE = f"tcp/127.0.0.1:{PORT}"
_ENDPOINT = re.compile(
    r"(tcp|udp|tls|quic|ws)/(\[[0-9A-Fa-f:.%]+\]|[^\s/:\[\]]+):\d{1,5}([?#].*)?$|unixsock-stream/."
)
_RETRY = 0.1
_QUIET = 0.06


class BusSettings(Struct, frozen=True, forbid_unknown_fields=True):
    """How to join the bus. On an open LAN: peers that find each other, in any order."""

    mode: Literal["peer", "client", "router"] = "peer"
    connect: list[str] = []
    """endpoints such as tcp/pi.local:7447, besides what multicast finds"""
    listen: list[str] = []
    multicast: bool = True
    patience: Annotated[float, Meta(ge=0, le=3600)] = 3.0
    """s a client waits for its router"""


def open_session(settings: BusSettings, *, settle: bool = False) -> zenoh.Session:
    """Join the bus; with `settle`, first wait (at most 0.5 s) until everybody is found.

    Raises ConfigError for an endpoint that is none, BusError when there is no router to a client.
    """
    config = _configure(settings, settle)
    give_up = time.monotonic() + settings.patience
    while True:
        try:
            session = zenoh.open(config)
            return _settle(session) if settle else session
        except zenoh.ZError as error:
            if settings.mode != "client" or time.monotonic() > give_up:
                raise BusError(_words(settings, error)) from error
        time.sleep(_RETRY)


def _settle(session: zenoh.Session) -> zenoh.Session:
    """Wait until no further peer has been found for a while: each tells of the ones it knows."""
    found: set[str] = set()
    quiet_at = time.monotonic() + _QUIET
    while time.monotonic() < quiet_at:
        now_found = {str(peer) for peer in [*session.info.peers_zid(), *session.info.routers_zid()]}
        if now_found != found:
            found, quiet_at = now_found, time.monotonic() + _QUIET
        time.sleep(0.005)
    return session


def _configure(settings: BusSettings, settle: bool) -> zenoh.Config:
    for endpoint in (*settings.connect, *settings.listen):
        if not _ENDPOINT.match(endpoint):
            raise ConfigError(
                f"an endpoint is such as tcp/pi.local:{PORT} or tcp/[::]:{PORT}, found {endpoint!r}"
            )
    connect = settings.connect or ([SAME_MACHINE] if settings.mode == "peer" and settings.multicast else [])
    values = {
        "mode": settings.mode,
        "connect/endpoints": connect,
        "connect/timeout_ms": 0 if settings.mode == "client" else -1,  # -1: goes on trying behind our back
        "connect/exit_on_failure": settings.mode == "client",
        "connect/retry": {"period_init_ms": 100, "period_max_ms": 1000, "period_increase_factor": 1.5},
        "listen/exit_on_failure": len(settings.listen) < 2,  # of several, what is taken is left out
        "scouting/multicast/enabled": settings.multicast,
        "scouting/delay": 500 if settle and settings.multicast else 0,
        "transport/shared_memory/enabled": False,
        "transport/link/tx/lease": 1000,
        "transport/link/tx/keep_alive": 4,
    }
    if settings.listen:
        values["listen/endpoints"] = settings.listen
    config = zenoh.Config()
    for key, value in values.items():
        try:
            config.insert_json5(key, json.dumps(value))
        except zenoh.ZError as error:
            raise ConfigError(f"bus: {value!r} cannot be {key}: {error}") from None
    return config


def _words(settings: BusSettings, error: zenoh.ZError) -> str:
    reason = str(error).partition(" at /")[0]
    if settings.mode == "client":
        where = ", ".join(settings.connect) or "by multicast"
        return f"no router found ({where}); is the robot on, and its address right? ({reason})"
    return f"cannot open the bus: {reason}"
