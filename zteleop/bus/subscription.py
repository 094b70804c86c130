"""An inbox: zenoh fills a ring, its reader empties it; what a slow reader misses is the oldest."""

from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext
from typing import Any, Generic, NamedTuple, TypeVar

from zteleop.bus import clock, codec
from zteleop.bus.codec import Decoder
from zteleop.bus.lag import Lag
from zteleop.bus.session import Ring, Sample
from zteleop.control.proof import Proof
from zteleop.errors import MessageError
from zteleop.messages import Message

M = TypeVar("M", bound=Message)


class Received(NamedTuple, Generic[M]):
    """A message, and how it came."""

    message: M
    key: str
    proof: Proof | None
    at: float
    """when it was read, by the bus clock"""
    came: float = 0.0
    """when this machine had it, by the same clock; 0 where nobody took note"""

    @property
    def source(self) -> str:
        """The last part of the key: the kind of sender, for a command."""
        return self.key.rpartition("/")[2]


class Subscription(Generic[M]):
    """Messages of one topic; iterate over it, or give it a handler and let the node spin."""

    def __init__(
        self,
        ring: Ring,
        accepted: dict[str, Decoder],
        complain: Callable[[str], None],
        handling: Callable[[], AbstractContextManager[object]] = nullcontext,
        lag: Lag | None = None,
    ) -> None:
        self.ring = ring
        self._accepted = accepted
        self._complain = complain
        self._handling = handling
        self.lag = lag or Lag()
        self.on_wait: Callable[[], object] = _nothing
        """called when somebody begins to iterate, and runs no loop meanwhile"""
        self.dropped = 0

    def __iter__(self) -> Iterator[M]:
        """Yield messages as they come, until the node is closed."""
        self.on_wait()
        while True:
            if sample := self.ring.try_recv():
                self.lag.goes_on()
            else:
                self.lag.is_over()
                try:
                    sample = self.ring.recv()
                except EOFError:
                    return
            if received := self.read(sample):
                with self._handling():  # what the body commands, it decided on what was heard before
                    yield received.message

    def take(self) -> Iterator[Received[M]]:
        """Yield what has arrived, without waiting."""
        while (sample := self.ring.try_recv()) is not None:
            received = self.read(sample)
            if received:
                yield received

    def newest(self) -> M | None:
        """Return the last message that has arrived since the last call, whatever has come after it."""
        samples = []
        while (sample := self.ring.try_recv()) is not None:
            samples.append(sample)
        for sample in reversed(samples):
            if found := self.read(sample):
                return found.message
        return None

    def read(self, sample: Sample) -> Received[M] | None:
        """Return the message in a sample; None, counted and said, when it is none."""
        key, payload, encoding, attachment, is_put, came = sample
        if not is_put or "*" in key:
            self._drop(key, "a delete or a wildcard is no message")
            return None
        try:
            message: Any = codec.decode(payload, encoding, self._accepted)
        except MessageError as error:
            self._drop(key, str(error))
            return None
        proof = codec.unpack_proof(attachment) if attachment is not None else None
        return Received(message, key, proof, clock.now(), came)

    def _drop(self, key: str, why: str) -> None:
        self.dropped += 1
        self._complain(f"{key}: dropped: {why}")


def _nothing() -> None:
    """Tell nobody."""
