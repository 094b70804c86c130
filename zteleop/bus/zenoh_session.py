"""A session of zenoh as keys and bytes; only this file, `zenoh_open` and `linger` know zenoh."""

import atexit
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from queue import Empty, SimpleQueue
from typing import Any, Self, TypeVar
from weakref import WeakSet

import zenoh

from zteleop.bus.loop import Loop
from zteleop.bus.overheard import OverheardRing
from zteleop.bus.pump import Pump
from zteleop.bus.session import Inbox, Question, Reply, Sample, Undeclarable
from zteleop.errors import BusError
from zteleop.machine.signals import sheltered

T = TypeVar("T")

_REPLY_WITHIN = 1.5
"""s for everybody to say which tokens there are"""
_WORDS = "text/plain"
"""the encoding of a refusal"""
_DROPPED_WITHIN = 0.05
"""s for threads of zenoh, once it is closed, to drop what is Python's"""
_MOST = 50_000
"""tokens that are taken in; a stranger may declare any number"""


class ZenohSession:
    """A session of zenoh, as a node wants it, and as the door does."""

    def __init__(self, zenoh_session: zenoh.Session, connect: Sequence[str] = ()) -> None:
        self.zenoh = zenoh_session
        self._connect = connect
        self._kept: list[Undeclarable] = []
        self._overheard: WeakSet[OverheardRing] = WeakSet()
        _open.add(self)

    def subscribe(self, key: str, depth: int) -> "ZenohRing":
        return ZenohRing(self.zenoh.declare_subscriber(key, zenoh.handlers.RingChannel(depth)))

    def overhear(self, key: str, depth: int) -> OverheardRing:
        ring = OverheardRing(depth)
        ring.declared = self.hear(key, ring.take)
        self._overheard.add(ring)
        return ring

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

    def unreached(self) -> Sequence[str]:
        there = [*self.zenoh.info.peers_zid(), *self.zenoh.info.routers_zid()]
        return () if there else self._connect

    def declare_token(self, key: str) -> None:
        self._kept.append(self.stand(key))

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
        found: set[str] = set()
        told: SimpleQueue[None] = SimpleQueue()

        def take(reply: zenoh.Reply) -> None:
            if reply.ok and len(found) < _MOST:
                found.add(str(reply.ok.key_expr))

        # Not by a channel: zenoh's holds 256, and whoever fills it here is who should empty it.
        replies: Any = zenoh.handlers.Callback(take, lambda: told.put(None), indirect=False)
        with sheltered():  # zenoh may answer at once, in this thread, and drops what a callback raises
            self.zenoh.liveliness().get(selector, replies, timeout=_REPLY_WITHIN)
        _await(told, _REPLY_WITHIN)  # zenoh's own patience with who is frozen is longer
        return set(found)

    def watch_tokens(self, selector: str, depth: int, history: bool = False) -> "ZenohRing":
        handler: Any = zenoh.handlers.RingChannel(depth)
        return ZenohRing(self.zenoh.liveliness().declare_subscriber(selector, handler, history=history))

    def serve(self, key: str, take: Callable[[Question], object]) -> None:
        self._kept.append(self.heed(key, take))

    def heed(self, key: str, take: Callable[[Question], object]) -> Undeclarable:
        """Call `take` in a thread of zenoh's for what is asked; raises BusError for a key that is none."""
        handler: Any = zenoh.handlers.Callback(lambda query: take(to_question(query)), indirect=False)
        with _in_words():
            return self.zenoh.declare_queryable(key, handler, complete=True)

    def ask(self, key: str, payload: bytes, encoding: str, seconds: float) -> Reply | None:
        told: SimpleQueue[zenoh.Reply | None] = SimpleQueue()
        handler: Any = zenoh.handlers.Callback(told.put, lambda: told.put(None), indirect=False)
        about: Any = {"payload": payload, "encoding": zenoh.Encoding(encoding), "timeout": seconds}
        with _in_words(), sheltered():  # as for tokens
            self.zenoh.get(key, handler, **about)
        reply = _await(told, seconds + _REPLY_WITHIN)
        return to_reply(reply) if reply else None

    def deliver(self, inbox: Inbox, handler: Callable[[Any], object], loop: Loop) -> Pump:
        return Pump(inbox, handler, loop)

    def attend(self, tell: Callable[[], object], loop: Loop, within: float) -> None:
        loop.every(within, tell)

    def close(self) -> None:
        _open.discard(self)
        self.zenoh.close()  # type: ignore[no-untyped-call]
        for ring in self._overheard:
            ring.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()


def _await(told: "SimpleQueue[T]", seconds: float) -> T | None:
    """Return what a thread of zenoh's tells; None where it does not within some seconds.

    Not by an Event: a Ctrl-C that raises while its Condition takes its lock back leaves that locked, and
    zenoh's thread, which waits for it in `set`, keeps whoever closes the session waiting.
    """
    try:
        return told.get(timeout=seconds)
    except Empty:
        return None


_open: WeakSet[ZenohSession] = WeakSet()


@atexit.register
def _close_all() -> None:
    """Leave the bus where a program ends without having done so: callbacks would abort Python's own end."""
    left = list(_open)
    for session in left:
        with suppress(zenoh.ZError):
            session.close()
    if left:
        time.sleep(_DROPPED_WITHIN)


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
        try:
            sample = self._subscriber.try_recv()
        except zenoh.ZError:  # it is closed, which `recv` tells
            return None
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


def to_question(query: zenoh.Query) -> Question:
    """Return a query as plain bytes, which is over once it is answered."""

    def answer(payload: bytes, encoding: str) -> None:
        with query, suppress(zenoh.ZError):  # whoever asked is gone
            query.reply(query.key_expr, payload, encoding=zenoh.Encoding(encoding))

    def refuse(words: str) -> None:
        with query, suppress(zenoh.ZError):
            query.reply_err(words.encode(errors="replace"), encoding=zenoh.Encoding(_WORDS))

    payload = b"" if query.payload is None else bytes(query.payload)
    return Question(payload, str(query.encoding or ""), answer, refuse)


def to_reply(reply: zenoh.Reply) -> Reply | None:
    """Return an answer as plain bytes; None for the word of somebody's zenoh that nobody answered in time."""
    if reply.ok:
        return Reply(bytes(reply.ok.payload), str(reply.ok.encoding), refused=False)
    if reply.err is None:
        return None
    refusal = Reply(bytes(reply.err.payload), str(reply.err.encoding), refused=True)
    is_zenohs_own = refusal.payload == b"Timeout" and refusal.encoding != _WORDS
    return None if is_zenohs_own else refusal


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
