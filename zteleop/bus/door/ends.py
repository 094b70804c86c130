"""What a session by way of the door hands out: rings that hear, and outlets that speak."""

from collections import deque
from typing import Protocol

from zteleop.bus.door.frames import Put
from zteleop.bus.door.turns import Turns
from zteleop.bus.session import Sample


class Way(Protocol):
    """The session they belong to."""

    closed: bool

    def glance(self) -> None:
        """Take in what has arrived, unless somebody has just looked in vain."""

    def await_more(self, give_up: float) -> None:
        """Wait a little for something to arrive, and take it in."""

    def put(self, frame: Put) -> None:
        """Say something, or nothing while there is no door; raises BusError when the session is closed."""

    def undeclare(self, identity: int) -> None:
        """Take back what was declared."""


class RemoteRing:
    """Keeps the newest samples; whoever finds it empty takes in what has arrived for any."""

    def __init__(self, way: Way, identity: int, depth: int) -> None:
        self._way = way
        self._id = identity
        self._samples: deque[Sample] = deque(maxlen=depth)
        self.skipped = 0
        self.turns: Turns | None = None

    @property
    def is_empty(self) -> bool:
        return not self._samples

    def take(self, sample: Sample) -> None:
        """Keep a sample that has arrived."""
        self.skipped += len(self._samples) == self._samples.maxlen
        self._samples.append(sample)
        if self.turns:
            self.turns.wake()

    def try_recv(self) -> Sample | None:
        if not self._samples:
            self._way.glance()
        return self._samples.popleft() if self._samples else None

    def recv(self) -> Sample:
        while not self._samples:
            if self._way.closed:
                raise EOFError
            self._way.await_more(float("inf"))
        return self._samples.popleft()

    def undeclare(self) -> None:
        self._way.undeclare(self._id)


class RemoteOutlet:
    """Says bytes under one key, by way of the door."""

    matched = True

    def __init__(self, way: Way, identity: int) -> None:
        self._way = way
        self._id = identity

    def put(self, payload: bytes, encoding: str, attachment: bytes | None) -> None:
        self._way.put(Put(self._id, payload, encoding, attachment))
