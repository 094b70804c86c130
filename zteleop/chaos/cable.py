"""A link in the hand: a relay on one machine that can be cut, slowed down and choked."""

import select
import socket
import threading
import time
from collections import deque
from contextlib import suppress
from pathlib import Path
from typing import Self

PIECE = 65536
QUEUE = 1 << 20
"""bytes on their way, after which whoever sends must wait"""
LOOK = 0.005
HERE = "127.0.0.1"


class Way:
    """One direction of one connection: what is on its way, and when it arrives."""

    def __init__(self, source: socket.socket, sink: socket.socket, *, forth: bool) -> None:
        self.source = source
        self.sink = sink
        self.forth = forth
        self.ended = False
        self._flying: deque[tuple[float, bytes]] = deque()
        self._weight = 0
        self._busy_until = 0.0

    @property
    def weight(self) -> int:
        """How many bytes are on their way."""
        return self._weight

    def carry(self, now: float, delay: float, rate: float | None) -> None:
        """Take what was said; it arrives after a delay, and no faster than `rate` bytes a second."""
        data = b""
        with suppress(OSError):
            data = self.source.recv(PIECE)
        self._busy_until = max(now, self._busy_until) + (len(data) / rate if rate else 0.0)
        self._flying.append((self._busy_until + delay, data))
        self._weight += len(data)
        self.ended = not data

    def deliver(self, now: float) -> None:
        """Hand over what has arrived; the end of a connection arrives as well."""
        while self._flying and self._flying[0][0] <= now:
            data = self._flying.popleft()[1]
            self._weight -= len(data)
            with suppress(OSError):
                self.sink.sendall(data) if data else self.sink.shutdown(socket.SHUT_WR)


class Cable:
    """Relays every connection to `place` to whoever listens at `target`; each is a Unix socket or a TCP port.

    What is said while it is cut waits until it is mended, as in a network that sends again; nobody is told.
    """

    def __init__(self, target: Path | int, place: Path | int = 0, queue: int = QUEUE) -> None:
        self.delay = 0.0
        """s, each way"""
        self.rate: float | None = None
        """bytes a second, each way"""
        self._target = target
        self._queue = queue
        self._listener = _listen(place)
        self.port = 0 if isinstance(place, Path) else int(self._listener.getsockname()[1])
        self._ways: list[Way] = []
        self._cut: set[bool] = set()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, name="cable", daemon=True)
        self._thread.start()

    def cut(self, *, forth: bool = True, back: bool = True) -> None:
        """Let nothing through to the robot, or back from it."""
        self._cut = {way for way, dead in ((True, forth), (False, back)) if dead}

    def mend(self) -> None:
        """Let through what waited, and what comes."""
        self._cut = set()

    def close(self) -> None:
        self._ended.set()
        for way in self._ways:
            with suppress(OSError):  # whoever waits to say more to somebody frozen waits no longer
                way.source.shutdown(socket.SHUT_RDWR)
        self._thread.join()
        for end in (self._listener, *(way.source for way in self._ways)):
            end.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _run(self) -> None:
        while not self._ended.is_set():
            ready = {w.source: w for w in self._ways if not self._holds(w)}
            heard = select.select([self._listener, *ready], [], [], LOOK)[0]
            now = time.monotonic()
            for end in heard:
                self._accept() if end is self._listener else ready[end].carry(now, self.delay, self.rate)
            for way in self._ways:
                if way.forth not in self._cut:
                    way.deliver(now)

    def _holds(self, way: Way) -> bool:
        """Say whether whoever speaks must wait."""
        return way.ended or way.weight >= self._queue or way.forth in self._cut

    def _accept(self) -> None:
        here = self._listener.accept()[0]
        try:
            there = _connect(self._target)
        except OSError:
            here.close()
            return
        self._ways += [Way(here, there, forth=True), Way(there, here, forth=False)]


def _listen(place: Path | int) -> socket.socket:
    if isinstance(place, int):
        return socket.create_server((HERE, place))
    listener = socket.socket(socket.AF_UNIX)
    listener.bind(str(place))
    listener.listen()
    return listener


def _connect(target: Path | int) -> socket.socket:
    if isinstance(target, int):
        return socket.create_connection((HERE, target))
    end = socket.socket(socket.AF_UNIX)
    try:
        end.connect(str(target))
    except OSError:
        end.close()
        raise
    return end
