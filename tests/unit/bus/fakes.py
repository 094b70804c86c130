"""The few zenoh objects that the bus uses, without a network."""

from collections import deque
from collections.abc import Iterable
from types import SimpleNamespace
from typing import Any

import zenoh

from zteleop.bus import codec
from zteleop.messages import Message


class Clock:
    """The bus clock, where a test decides what time it is."""

    def __init__(self, time: float = 1000.0) -> None:
        self.time = time

    def now(self) -> float:
        return self.time

    def pass_by(self, seconds: float) -> None:
        self.time += seconds


class Sample:
    def __init__(
        self,
        payload: bytes,
        encoding: str = "application/json;std_msgs/msg/String",
        key: str = "robot/archangel/chatter",
        attachment: bytes | None = None,
        kind: zenoh.SampleKind = zenoh.SampleKind.PUT,
    ) -> None:
        self.payload, self.encoding, self.kind = payload, zenoh.Encoding(encoding), kind
        self.key_expr, self.attachment = key, attachment


def sample(message: Message, key: str = "robot/archangel/chatter", attachment: bytes | None = None) -> Sample:
    return Sample(codec.encode(message), codec.encoding_of(type(message)), key, attachment)


class Ring:
    """A subscriber's ring: closed as soon as it is empty."""

    def __init__(self, *samples: Sample) -> None:
        self.samples = deque(samples)
        self.declared = True

    def undeclare(self) -> None:
        self.declared = False

    def recv(self) -> Sample:
        if not self.samples:
            raise zenoh.ZError("closed")
        return self.samples.popleft()

    def try_recv(self) -> Sample | None:
        return self.samples.popleft() if self.samples else None


class Put(SimpleNamespace):
    """What was put: payload, encoding and attachment."""


class ZenohPublisher:
    def __init__(self) -> None:
        self.puts: list[Put] = []
        self.matching_status = SimpleNamespace(matching=False)

    def put(self, payload: bytes, *, encoding: zenoh.Encoding, attachment: bytes | None) -> None:
        self.puts.append(Put(payload=payload, encoding=str(encoding), attachment=attachment))


class Liveliness:
    def __init__(self, keys: Iterable[str] = ()) -> None:
        self.keys = list(keys)

        self.ring = Ring()

    def declare_token(self, key: str) -> str:
        self.keys.append(key)
        return key

    def declare_subscriber(self, key: str, handler: object, history: bool = False) -> "Ring":
        return self.ring

    def get(self, selector: str, timeout: float) -> list[Any]:
        wanted = zenoh.KeyExpr(selector)
        replies = [SimpleNamespace(ok=SimpleNamespace(key_expr=key)) for key in self.keys]
        found = [reply for reply in replies if wanted.intersects(zenoh.KeyExpr(reply.ok.key_expr))]
        return [*found, SimpleNamespace(ok=None)]


class Session:
    """Remembers what was declared on it."""

    def __init__(self, tokens: Iterable[str] = ()) -> None:
        self.alive = Liveliness(tokens)
        self.rings: dict[str, Ring] = {}
        self.publishers: dict[str, tuple[ZenohPublisher, dict[str, Any]]] = {}
        self.closed = False

    def liveliness(self) -> Liveliness:
        return self.alive

    def declare_subscriber(self, key: str, handler: object) -> Ring:
        ring = self.rings.setdefault(key, Ring())
        ring.declared = True
        return ring

    def declare_publisher(self, key: str, **qos: Any) -> ZenohPublisher:
        return self.publishers.setdefault(key, (ZenohPublisher(), qos))[0]

    def close(self) -> None:
        self.closed = True
