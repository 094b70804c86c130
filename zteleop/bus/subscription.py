"""An inbox: zenoh fills a ring, its reader empties it; what a slow reader misses is the oldest."""

import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, nullcontext, suppress
from typing import Any, Generic, NamedTuple, Protocol, TypeVar

import zenoh

from zteleop.bus import clock, codec
from zteleop.bus.codec import Decoder
from zteleop.bus.loop import Loop
from zteleop.control.proof import Proof
from zteleop.errors import MessageError
from zteleop.messages import Message

M = TypeVar("M", bound=Message)
T = TypeVar("T")
T_co = TypeVar("T_co", covariant=True)


class Received(NamedTuple, Generic[M]):
    """A message, and how it came."""

    message: M
    key: str
    proof: Proof | None
    at: float
    """when it was read, by the bus clock"""

    @property
    def source(self) -> str:
        """The last part of the key: the kind of sender, for a command."""
        return self.key.rpartition("/")[2]


class Subscription(Generic[M]):
    """Messages of one topic; iterate over it, or give it a handler and let the node spin."""

    def __init__(
        self,
        subscriber: "zenoh.Subscriber[Any]",
        accepted: dict[str, Decoder],
        complain: Callable[[str], None],
        handling: Callable[[], AbstractContextManager[object]] = nullcontext,
    ) -> None:
        self.ring, self._accepted, self._complain = subscriber, accepted, complain
        self._handling = handling
        self.dropped = 0

    def __iter__(self) -> Iterator[M]:
        """Yield messages as they come, until the node is closed."""
        while True:
            try:
                sample = self.ring.recv()
            except zenoh.ZError:
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
        received = (self.read(sample) for sample in reversed(samples))
        return next((found.message for found in received if found), None)

    def read(self, sample: zenoh.Sample) -> Received[M] | None:
        """Return the message in a sample; None, counted and said, when it is none."""
        key = str(sample.key_expr)
        if sample.kind != zenoh.SampleKind.PUT or "*" in key:
            self._drop(key, "a delete or a wildcard is no message")
            return None
        try:
            message: Any = codec.decode(bytes(sample.payload), str(sample.encoding), self._accepted)
        except MessageError as error:
            self._drop(key, str(error))
            return None
        attachment = sample.attachment
        proof = codec.unpack_proof(bytes(attachment)) if attachment is not None else None
        return Received(message, key, proof, clock.now())

    def _drop(self, key: str, why: str) -> None:
        self.dropped += 1
        self._complain(f"{key}: dropped: {why}")


class Ring(Protocol[T_co]):
    """What a pump empties: a ring of samples, and how to read one."""

    ring: Any

    def read(self, sample: zenoh.Sample) -> T_co | None: ...


class Pump(Generic[T]):
    """Wakes the loop for a subscription's handler.

    Its thread takes one sample and waits until the loop has emptied the ring, one message a
    round: a flood, or a slow handler, costs the other topics one run of that handler at most.
    `begin` is what its thread does first, such as to ask for the priority that its loop's has.
    """

    def __init__(
        self,
        subscription: Ring[T],
        handler: Callable[[T], object],
        loop: Loop,
        begin: Callable[[], object] | None = None,
    ) -> None:
        self._subscription, self._handler, self._loop = subscription, handler, loop
        self._begin = begin
        self._sample: zenoh.Sample | None = None
        self._emptied = threading.Lock()  # held while the loop is at work; an Event costs three times as much
        self._emptied.acquire()
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="inbox", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the thread; the session must be closed first."""
        self._closed = True
        self._go_on()
        self._thread.join()

    def _run(self) -> None:
        try:
            if self._begin:
                self._begin()
            self._wait()
        except BaseException as error:  # an inbox that nobody empties any more must not go unnoticed
            self._loop.fail(error)

    def _wait(self) -> None:
        receive = self._subscription.ring.recv
        while not self._closed:
            try:
                self._sample = receive()
            except zenoh.ZError:
                return
            if self._closed:  # the loop will not come for it any more
                return
            self._loop.call_soon(self._hand_over)
            self._emptied.acquire()

    def _hand_over(self) -> None:
        sample = self._sample
        try:
            received = sample and self._subscription.read(sample)
            if received is not None:
                self._handler(received)
        finally:
            self._go_on_with_the_rest()

    def _go_on_with_the_rest(self) -> None:
        if not self._closed:
            self._sample = self._subscription.ring.try_recv()
            if self._sample is None:
                self._go_on()
            else:
                self._loop.call_next(self._hand_over)

    def _go_on(self) -> None:
        with suppress(RuntimeError):  # nobody waits
            self._emptied.release()
