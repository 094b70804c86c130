"""How zenoh is opened: its threads, limits and patience, from settings."""

import json
import os
import re
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

import zenoh

from zteleop.bus import linger, networks
from zteleop.bus.settings import ANY_PORT, ENDPOINT, PORT, SAME_MACHINE, BusSettings
from zteleop.errors import BusError, ConfigError
from zteleop.machine import signals, stderr

_ENDPOINT = re.compile(ENDPOINT)
_RUNTIME = "ZENOH_RUNTIME"
_THREADS = "(rx:({rx}),acc:(handover:app),tx:({tx}),net:(handover:app),app:(worker_threads:1))"
_ONE_THREAD = _THREADS.format(rx="handover:app", tx="handover:app")
"""Half the latency of an idle link."""
_APART = _THREADS.format(rx="worker_threads:1", tx="worker_threads:1")
"""For who passes messages on: receiving may wait for sending, and one thread would wait for itself."""
_POOL = r"(acc|app|net|rx|tx):\((?:worker_threads:[1-9]\d?|handover:(?:acc|app|net|rx|tx))\)"
_POOLS = re.compile(rf"\({_POOL}(,{_POOL})*\)")
_PATIENCE_US = 100_000
"""for who passes messages on: a client that takes none for so long is let go, before it holds up the commands
of others; zenoh's own patience is 5 s"""
_SAYS_FOR_US = 5_000_000
"""for who says something once: how long that waits for a place on a full link; else it is a millisecond"""
_SPEAKS_WITHIN_MS, _UNSPOKEN = 1000, 300
"""for the same: a connection that says nothing for so long is let go, and so many may be there at once; of
zenoh's own there are 100, for 10 s, and whoever comes then waits for as long"""
_SESSIONS = 200
"""for the same: each costs 90 kB, and a class of thirty has some 120; with the connections that say nothing
they are fewer than the 1024 files a process may usually have open"""
_RETRY = 0.1
_TELL_AFTER = 1.0
"""s of waiting for a router, after which that is said"""
_LOOK_EVERY, _QUIET, _LOOKS = 0.005, 12, 100
"""s between two looks at who is there; how many of them find nobody new, and how many there are at most"""


def open_zenoh(
    settings: BusSettings, *, settle: bool = False, door: bool = False, patient: bool = False
) -> zenoh.Session:
    """Join the bus; with `settle`, first wait (a second, longer on a busy machine) until everybody is found.

    With `door`, others join through this session; with `patient`, what is said waits for a full link.

    Raises ConfigError for an endpoint that is none, BusError when there is no router to a client.
    """
    config = _configure(settings, settle, door, patient)
    give_up = time.monotonic() + settings.patience
    with _telling(settings):
        while True:
            try:
                session = _open(config, door or settings.mode == "router")
                return _settled(session, settle)
            except zenoh.ZError as error:
                if settings.mode != "client" or time.monotonic() > give_up:
                    raise BusError(_words(settings, error)) from error
            time.sleep(_RETRY)


@contextmanager
def _telling(settings: BusSettings) -> Iterator[None]:
    """Say for whom a client waits, where that lasts; zenoh gives nobody a word meanwhile."""
    if settings.mode != "client":
        yield
        return
    routers = " or ".join(settings.connect) or "any router"
    teller = threading.Timer(_TELL_AFTER, stderr.tell, (f"waits for a router, {routers}",))
    teller.daemon = True
    signals.start(teller)
    try:
        yield
    finally:
        teller.cancel()


def _open(config: zenoh.Config, door: bool) -> zenoh.Session:
    """Open with the threads that suit; zenoh looks at them once, and no child process should inherit them."""
    if wanted := os.environ.get(_RUNTIME):
        _check_threads(wanted)
        return zenoh.open(config)
    os.environ[_RUNTIME] = _APART if door else _ONE_THREAD
    try:
        return zenoh.open(config)
    finally:
        del os.environ[_RUNTIME]


def _check_threads(text: str) -> None:
    """Raise ConfigError for what zenoh would not only refuse, but die of."""
    pools = re.findall(_POOL, text)
    if not _POOLS.fullmatch(text) or len(set(pools)) != len(pools):
        raise ConfigError(f"{_RUNTIME} is such as {_APART}, found {text!r}; correct it, or unset it")


def _settled(session: zenoh.Session, settle: bool) -> zenoh.Session:
    """Return a session whose links do not linger; with `settle`, once no further peer is found."""
    try:
        linger.forbid(session)
        if settle:
            _await_quiet(session)
        return session
    except BaseException:
        session.close()  # type: ignore[no-untyped-call]
        raise


def _await_quiet(session: zenoh.Session) -> None:
    """Wait until nobody new is found for a while, by looks: where looks come late, so does who is found."""
    found: set[str] = set()
    quiet = 0
    for _ in range(_LOOKS):
        now_found = {str(peer) for peer in [*session.info.peers_zid(), *session.info.routers_zid()]}
        quiet = quiet + 1 if now_found == found else 0
        if quiet >= _QUIET:
            return
        found = now_found
        time.sleep(_LOOK_EVERY)


def _configure(
    settings: BusSettings, settle: bool, door: bool = False, patient: bool = False
) -> zenoh.Config:
    for endpoint in (*settings.connect, *settings.listen):
        if not _ENDPOINT.match(endpoint):
            raise ConfigError(
                f"an endpoint is such as tcp/pi.local:{PORT} or tcp/[::]:{PORT}, found {endpoint!r}"
            )
    connect = settings.connect or ([SAME_MACHINE] if settings.mode == "peer" and settings.multicast else [])
    values: dict[str, object] = {
        "mode": settings.mode,
        "connect/endpoints": connect,
        "connect/timeout_ms": 0 if settings.mode == "client" else -1,  # -1: goes on trying behind our back
        "connect/exit_on_failure": settings.mode == "client",
        "connect/retry": {"period_init_ms": 100, "period_max_ms": 300, "period_increase_factor": 1.5},
        "listen/exit_on_failure": True,
        "scouting/multicast/enabled": settings.multicast,
        "scouting/delay": 500 if settle and settings.multicast else 0,
        "transport/shared_memory/enabled": False,
        "transport/link/rx/max_message_size": settings.largest,
        "transport/unicast/open_timeout": 3000,  # ms; a close waits for an attempt to connect
        "transport/link/tx/lease": 1000,
        "transport/link/tx/keep_alive": 4,
    }
    if door or settings.mode == "router":
        values["transport/link/tx/queue/congestion_control/block/wait_before_close"] = _PATIENCE_US
        values["transport/unicast/accept_timeout"] = _SPEAKS_WITHIN_MS
        values["transport/unicast/accept_pending"] = _UNSPOKEN
        values["transport/unicast/max_sessions"] = _SESSIONS
    if patient:
        for name in ("wait_before_drop", "max_wait_before_drop_fragments"):
            values[f"transport/link/tx/queue/congestion_control/drop/{name}"] = _SAYS_FOR_US
    if settings.listen:
        values["listen/endpoints"] = settings.listen
    if networks.is_in_none():
        listen = settings.listen or ([ANY_PORT] if settings.mode == "peer" else [])
        if ANY_PORT in listen:  # others are told of its addresses in networks alone
            values["listen/endpoints"] = [*listen, "tcp/127.0.0.1:0"]
        values["scouting/multicast/interface"] = networks.LOOPBACK
    config = zenoh.Config()
    for key, value in values.items():
        try:
            config.insert_json5(key, json.dumps(value))
        except zenoh.ZError as error:
            reason = str(error).partition(" at /")[0]
            raise ConfigError(f"bus: {value!r} cannot be {key}: {reason}") from None
    return config


def _words(settings: BusSettings, error: zenoh.ZError) -> str:
    reason = str(error).partition(" at /")[0]
    if settings.mode == "client":
        where = ", ".join(settings.connect) or "by multicast"
        return f"no router found ({where}); is the robot on, and its address right? ({reason})"
    if "already in use" in reason and settings.listen:
        where = ", ".join(settings.listen)
        return f"cannot listen at {where}: already in use by another process; end that, or --listen elsewhere"
    return f"cannot open the bus: {reason}"
