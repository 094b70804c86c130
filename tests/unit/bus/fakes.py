"""A session without a network: it remembers what was declared on it."""

from collections import deque
from collections.abc import Callable, Iterable
from types import SimpleNamespace
from typing import Any

import zenoh

from zteleop.bus import codec
from zteleop.bus.pump import Pump
from zteleop.bus.session import Question, Reply, Sample
from zteleop.messages import Message


def put(
    payload: bytes,
    encoding: str = "application/json;std_msgs/msg/String",
    key: str = "robot/archangel/chatter",
    attachment: bytes | None = None,
    is_put: bool = True,
) -> Sample:
    return Sample(key, payload, encoding, attachment, is_put)


def sample(message: Message, key: str = "robot/archangel/chatter", attachment: bytes | None = None) -> Sample:
    return put(codec.encode(message), codec.encoding_of(type(message)), key, attachment)


class Ring:
    """A subscriber's ring: closed as soon as it is empty."""

    def __init__(self, *samples: Sample) -> None:
        self.samples = deque(samples)
        self.skipped = 0
        self.declared = True

    def undeclare(self) -> None:
        self.declared = False

    def recv(self) -> Sample:
        if not self.samples:
            raise EOFError("closed")
        return self.samples.popleft()

    def try_recv(self) -> Sample | None:
        return self.samples.popleft() if self.samples else None


class Put(SimpleNamespace):
    """What was put: payload, encoding and attachment."""


class Outlet:
    def __init__(self) -> None:
        self.puts: list[Put] = []
        self.matched = False

    def put(self, payload: bytes, encoding: str, attachment: bytes | None) -> None:
        self.puts.append(Put(payload=payload, encoding=encoding, attachment=attachment))


class Session:
    """Remembers what was declared on it."""

    def __init__(self, tokens: Iterable[str] = ()) -> None:
        self.alive, self.comings = list(tokens), Ring()
        self.rings: dict[str, Ring] = {}
        self.outlets: dict[str, tuple[Outlet, bool]] = {}
        self.served: dict[str, Callable[[Question], object]] = {}
        self.asked: list[tuple[str, bytes, str, float]] = []
        self.reply: Reply | None = None
        self.closed = False

    def serve(self, key: str, take: Callable[[Question], object]) -> None:
        self.served[key] = take

    def ask(self, key: str, payload: bytes, encoding: str, seconds: float) -> Reply | None:
        self.asked.append((key, payload, encoding, seconds))
        return self.reply

    def unreached(self) -> list[str]:
        return []

    def declare_token(self, key: str) -> None:
        self.alive.append(key)

    def tokens(self, selector: str) -> set[str]:
        wanted = zenoh.KeyExpr(selector)
        return {key for key in self.alive if wanted.intersects(zenoh.KeyExpr(key))}

    def watch_tokens(self, selector: str, depth: int, history: bool = False) -> Ring:
        return self.comings

    def subscribe(self, key: str, depth: int) -> Ring:
        ring = self.rings.setdefault(key, Ring())
        ring.declared = True
        return ring

    def overhear(self, key: str, depth: int) -> Ring:
        return self.subscribe(key, depth)

    def advertise(self, key: str, urgent: bool) -> Outlet:
        return self.outlets.setdefault(key, (Outlet(), urgent))[0]

    def deliver(self, inbox: Any, handler: Any, loop: Any) -> Pump:
        return Pump(inbox, handler, loop)

    def close(self) -> None:
        self.closed = True
