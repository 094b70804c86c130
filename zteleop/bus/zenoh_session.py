"""A session of zenoh, opened from settings: with `linger`, the only place that knows zenoh."""

import json
import os
import re
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Protocol, Self

import zenoh

from zteleop.bus import linger
from zteleop.bus.loop import Loop
from zteleop.bus.pump import Pump
from zteleop.bus.session import Inbox, Sample
from zteleop.bus.settings import PORT, SAME_MACHINE, BusSettings
from zteleop.errors import BusError, ConfigError

_ENDPOINT = re.compile(
    r"(tcp|udp|tls|quic|ws)/(\[[0-9A-Fa-f:.%]+\]|[^\s/:\[\]]+):\d{1,5}([?#].*)?$|unixsock-stream/."
)
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
_REPLY_WITHIN = 2.0
"""s for everybody to say which tokens there are"""
_QUIET, _SETTLED = 0.06, 0.5


class Undeclarable(Protocol):
    """What zenoh does until it is undeclared."""

    def undeclare(self) -> None:
        """Take it back."""


class ZenohSession:
    """A session of zenoh, as a node wants it, and as the door does."""

    def __init__(self, zenoh_session: zenoh.Session) -> None:
        self.zenoh = zenoh_session
        self._tokens: list[Undeclarable] = []

    def subscribe(self, key: str, depth: int) -> "ZenohRing":
        return ZenohRing(self.zenoh.declare_subscriber(key, zenoh.handlers.RingChannel(depth)))

    def hear(self, key: str, passes: Callable[[Sample], None]) -> Undeclarable:
        """Call `passes` in a thread of zenoh's for what is said; raises BusError for a key that is none."""
        with _in_words():
            return self.zenoh.declare_subscriber(key, _direct(passes))

    def hear_tokens(self, selector: str, passes: Callable[[Sample], None], history: bool) -> Undeclarable:
        """Call `passes` in a thread of zenoh's for tokens that come and go; raises BusError likewise."""
        with _in_words():
            return self.zenoh.liveliness().declare_subscriber(selector, _direct(passes), history=history)

    def advertise(self, key: str, urgent: bool) -> "ZenohOutlet":
        with _in_words():
            return ZenohOutlet(
                self.zenoh.declare_publisher(
                    key,
                    congestion_control=zenoh.CongestionControl.DROP,
                    priority=zenoh.Priority.REAL_TIME if urgent else zenoh.Priority.DATA,
                    express=urgent,
                )
            )

    def declare_token(self, key: str) -> None:
        self._tokens.append(self.stand(key))

    def stand(self, key: str) -> Undeclarable:
        """Declare a token for as long as what this returns is kept; raises BusError likewise."""
        with _in_words():
            return self.zenoh.liveliness().declare_token(key)

    def prove(self) -> None:
        """Declare something, which nobody else is told, and take it back.

        A stranger's declaration can break a lock of zenoh's: every later one then panics, and no newcomer is
        heard (docs/upstream/zenoh-poisoned-lock.md). A panic is no Exception; whoever meets one must end.
        """
        nobody: Any = zenoh.handlers.RingChannel(1)
        inside = zenoh.Locality.SESSION_LOCAL
        self.zenoh.declare_subscriber("zteleop/proof", nobody, allowed_origin=inside).undeclare()  # type: ignore[no-untyped-call]

    def tokens(self, selector: str) -> set[str]:
        replies = self.zenoh.liveliness().get(selector, timeout=_REPLY_WITHIN)
        return {str(reply.ok.key_expr) for reply in replies if reply.ok}

    def watch_tokens(self, selector: str, depth: int, history: bool = False) -> "ZenohRing":
        handler: Any = zenoh.handlers.RingChannel(depth)
        return ZenohRing(self.zenoh.liveliness().declare_subscriber(selector, handler, history=history))

    def deliver(self, inbox: Inbox, handler: Callable[[Any], object], loop: Loop) -> Pump:
        return Pump(inbox, handler, loop)

    def close(self) -> None:
        self.zenoh.close()  # type: ignore[no-untyped-call]

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()


class ZenohRing:
    """A subscriber whose samples are plain."""

    def __init__(self, subscriber: "zenoh.Subscriber[Any]") -> None:
        self._subscriber = subscriber

    def recv(self) -> Sample:
        try:
            return to_sample(self._subscriber.recv())
        except zenoh.ZError as error:
            raise EOFError(str(error)) from None

    def try_recv(self) -> Sample | None:
        sample = self._subscriber.try_recv()
        return None if sample is None else to_sample(sample)

    def undeclare(self) -> None:
        self._subscriber.undeclare()  # type: ignore[no-untyped-call]


class ZenohOutlet:
    """A publisher that is told everything at each put."""

    def __init__(self, publisher: zenoh.Publisher) -> None:
        self._publisher = publisher
        self._encodings: dict[str, zenoh.Encoding] = {}

    @property
    def matched(self) -> bool:
        # The stub calls it a bool; it is an object, and always true.
        return bool(getattr(self._publisher.matching_status, "matching"))  # noqa: B009

    def put(self, payload: bytes, encoding: str, attachment: bytes | None) -> None:
        known = self._encodings.get(encoding)
        if known is None:
            known = self._encodings[encoding] = zenoh.Encoding(encoding)
        try:  # not `_in_words`, which costs a microsecond
            self._publisher.put(payload, encoding=known, attachment=attachment)
        except zenoh.ZError as error:
            raise BusError(str(error)) from error

    def undeclare(self) -> None:
        self._publisher.undeclare()  # type: ignore[no-untyped-call]


@contextmanager
def _in_words() -> Iterator[None]:
    try:
        yield
    except zenoh.ZError as error:
        raise BusError(str(error)) from error


def _direct(passes: Callable[[Sample], None]) -> Any:
    return zenoh.handlers.Callback(lambda sample: passes(to_sample(sample)), indirect=False)


def to_sample(sample: zenoh.Sample) -> Sample:
    """Return a sample as plain bytes."""
    attachment = sample.attachment
    return Sample(
        str(sample.key_expr),
        bytes(sample.payload),
        str(sample.encoding),
        None if attachment is None else bytes(attachment),
        sample.kind == zenoh.SampleKind.PUT,
    )


def open_zenoh(
    settings: BusSettings, *, settle: bool = False, door: bool = False, patient: bool = False
) -> zenoh.Session:
    """Join the bus; with `settle`, first wait (at most 1 s) until everybody is found.

    With `door`, others join through this session; with `patient`, what is said waits for a full link.

    Raises ConfigError for an endpoint that is none, BusError when there is no router to a client.
    """
    config = _configure(settings, settle, door, patient)
    give_up = time.monotonic() + settings.patience
    while True:
        try:
            session = _open(config, door or settings.mode == "router")
            return _settled(session, settle)
        except zenoh.ZError as error:
            if settings.mode != "client" or time.monotonic() > give_up:
                raise BusError(_words(settings, error)) from error
        time.sleep(_RETRY)


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
    found: set[str] = set()
    quiet_at = time.monotonic() + _QUIET
    end = time.monotonic() + _SETTLED
    while time.monotonic() < min(quiet_at, end):
        now_found = {str(peer) for peer in [*session.info.peers_zid(), *session.info.routers_zid()]}
        if now_found != found:
            found, quiet_at = now_found, time.monotonic() + _QUIET
        time.sleep(0.005)


def _configure(
    settings: BusSettings, settle: bool, door: bool = False, patient: bool = False
) -> zenoh.Config:
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
    return f"cannot open the bus: {reason}"
