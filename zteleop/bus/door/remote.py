"""A session by way of the door: the process that has it holds nothing of zenoh's.

The door may go, and another come: what was declared is declared to it anew. What is said meanwhile is lost,
as on any bus.
"""

import select
import socket
import time
from collections.abc import Callable, Sequence
from itertools import count
from typing import Any, Self

from zteleop.bus import clock
from zteleop.bus.door.ends import RemoteOutlet, RemoteRing
from zteleop.bus.door.frames import (
    Advertise,
    Answer,
    Arrived,
    Asked,
    AskTokens,
    Declaration,
    Put,
    Replied,
    Serve,
    Stand,
    Subscribe,
    Tokens,
    Undeclare,
    WatchTokens,
)
from zteleop.bus.door.turns import Turns
from zteleop.bus.door.wire import Wire
from zteleop.bus.loop import Loop, Timer
from zteleop.bus.session import Inbox, Question, Reply, Sample
from zteleop.errors import BusError

REPLY_WITHIN = 3.0
"""s; zenoh itself answers within two"""
GLANCE = 0.0005
"""s after a look that found nothing, in which nobody looks again: many inboxes share one wire"""
KNOCK_EVERY = 0.05
"""s, where nobody listens at the place"""


class Remote:
    """Speaks and hears through whichever door listens at a place of this machine."""

    def __init__(self, place: str) -> None:
        self._place = place
        self._ids = count(1)
        self._declared: dict[int, Declaration] = {}
        self._rings: dict[int, RemoteRing] = {}
        self._takes: dict[int, Callable[[Question], object]] = {}
        """who is asked, by what was declared"""
        self._answers: dict[int, list[str]] = {}
        self._loop: Loop | None = None
        self._arrives: Callable[[], object] = self.read
        """what a loop does when something has arrived"""
        self._knock: Timer | None = None
        self._wire: Wire[Answer] | None = None
        self._looked = float("-inf")
        self.is_open = False
        self.closed = False
        self._join()

    def subscribe(self, key: str, depth: int) -> RemoteRing:
        return self._hear(Subscribe(next(self._ids), key, depth))

    def overhear(self, key: str, depth: int) -> RemoteRing:
        return self.subscribe(key, depth)

    def watch_tokens(self, selector: str, depth: int, history: bool = False) -> RemoteRing:
        return self._hear(WatchTokens(next(self._ids), selector, depth, history))

    def advertise(self, key: str, urgent: bool) -> RemoteOutlet:
        identity = next(self._ids)
        self._declare(Advertise(identity, key, urgent))
        return RemoteOutlet(self, identity)

    def unreached(self) -> Sequence[str]:
        return ()

    def declare_token(self, key: str) -> None:
        self._declare(Stand(next(self._ids), key))

    def serve(self, key: str, take: Callable[[Question], object]) -> None:
        identity = next(self._ids)
        self._takes[identity] = take
        self._declare(Serve(identity, key))

    def ask(self, key: str, payload: bytes, encoding: str, seconds: float) -> Reply | None:
        raise BusError("whoever is behind a door answers, and asks nobody")

    def tokens(self, selector: str) -> set[str]:
        """Return the tokens there are; raises BusError when no door answers."""
        asked, give_up = next(self._ids), time.monotonic() + REPLY_WITHIN
        wire = self._wire if self.wait(REPLY_WITHIN) else None
        if wire:
            wire.send(AskTokens(asked, selector), keep=True)
        while asked not in self._answers:
            if self.closed or time.monotonic() > give_up:
                raise BusError("the door of this robot does not answer")
            self.await_more(give_up)
        return set(self._answers.pop(asked))

    def deliver(self, inbox: Inbox, handler: Callable[[Any], object], loop: Loop) -> Turns:
        ring: Any = inbox.ring
        turns = Turns(inbox, handler, loop)
        ring.turns = turns
        if self._loop is None:
            self._loop, self._knock = loop, loop.alarm(self.read)
            self._watch()
        return turns

    def attend(self, tell: Callable[[], object], loop: Loop, within: float) -> None:
        """Tell that something has arrived; what follows within so many s waits, and is told of together."""
        self._loop, self._knock = loop, loop.alarm(self.read)

        def take_in() -> None:
            if self.read():
                tell()
                self._unwatch()
                again.ring_at(clock.now() + within)
            else:
                self._watch()

        again = loop.alarm(take_in)
        self._arrives = take_in
        self._watch()

    def wait(self, seconds: float) -> bool:
        """Wait for the door to open; True when it is."""
        give_up = time.monotonic() + seconds
        self.read()
        while not self.is_open and time.monotonic() < give_up:
            self.await_more(give_up)
        return self.is_open

    def await_more(self, give_up: float) -> None:
        """Wait a little for something to arrive, and take it in."""
        patience = max(0.0, min(give_up - time.monotonic(), 0.1))
        if self._wire:
            select.select([self._wire], [], [], patience)
        else:
            time.sleep(min(patience, 0.01))
        self.read()

    def glance(self) -> None:
        """Take in what has arrived, unless somebody has just looked in vain."""
        now = time.monotonic()
        if now - self._looked > GLANCE:
            self.read()

    def read(self) -> bool:
        """Take in what has arrived; True when something has."""
        if self.closed or not (self._wire or self._join()):
            self._knock_again()
            return False
        assert self._wire
        try:
            frames = self._wire.read()
        except EOFError:
            self._lose()
            return False
        for frame in frames:
            self._take(frame)
        if self._wire:
            self._wire.flush()
        self._looked = time.monotonic()
        return bool(frames)

    def put(self, frame: Put) -> None:
        """Say something, or nothing while there is no door; raises BusError when the session is closed."""
        wire = self._wire
        if self.closed:
            raise BusError("the session is closed")
        if wire and self.is_open:
            wire.send(frame)

    def undeclare(self, identity: int) -> None:
        """Take back what was declared."""
        self._rings.pop(identity, None)
        if self._declared.pop(identity, None) and self._wire and self.is_open:
            self._wire.send(Undeclare(identity), keep=True)

    def close(self) -> None:
        self.closed = True
        self._unwatch()
        if self._wire:
            self._wire.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()

    def _take(self, frame: Answer) -> None:
        if isinstance(frame, Arrived):
            if ring := self._rings.get(frame.id):
                ring.take(_sample(frame))
        elif isinstance(frame, Asked):
            self._pass_on(frame)
        elif isinstance(frame, Tokens):
            self._answers[frame.id] = frame.keys
        else:
            self._tell_all()

    def _pass_on(self, asked: Asked) -> None:
        def reply(payload: bytes, encoding: str, refused: bool = False) -> None:
            if self._wire and self.is_open:  # of another door perhaps, which knows no such question
                self._wire.send(Replied(asked.question, payload, encoding, refused), keep=True)

        def refuse(words: str) -> None:
            reply(words.encode(errors="replace"), "", refused=True)

        if take := self._takes.get(asked.id):
            take(Question(asked.payload, asked.encoding, reply, refuse))

    def _hear(self, declaration: Subscribe | WatchTokens) -> RemoteRing:
        ring = self._rings[declaration.id] = RemoteRing(self, declaration.id, declaration.depth)
        self._declare(declaration)
        return ring

    def _declare(self, declaration: Declaration) -> None:
        self._declared[declaration.id] = declaration
        if self._wire and self.is_open:
            self._wire.send(declaration, keep=True)

    def _tell_all(self) -> None:
        """Tell a door that has just opened what this process wants of it."""
        assert self._wire
        for declaration in self._declared.values():
            self._wire.send(declaration, keep=True)
        self.is_open = True

    def _join(self) -> bool:
        """Knock: the place outlives each door, and the next one answers."""
        end = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        end.setblocking(False)
        try:
            end.connect(self._place)
        except OSError:  # nobody is left who could open one
            end.close()
            return False
        self._wire = Wire(end, Answer)
        self._watch()
        return True

    def _lose(self) -> None:
        """Let go of a door that is gone, and knock at the next."""
        self._unwatch()
        wire, self._wire, self.is_open = self._wire, None, False
        if wire:
            wire.close()
        if not self._join():
            self._knock_again()

    def _knock_again(self) -> None:
        """Try to join a little later: a loop is woken only by a door that it has joined."""
        if self._knock and not self.closed:
            self._knock.ring_at(clock.now() + KNOCK_EVERY)

    def _watch(self) -> None:
        if self._loop and self._wire:
            self._loop.watch(self._wire.fileno(), self._arrives)

    def _unwatch(self) -> None:
        if self._loop and self._wire:
            self._loop.unwatch(self._wire.fileno())


def _sample(frame: Arrived) -> Sample:
    return Sample(frame.key, frame.payload, frame.encoding, frame.attachment, frame.is_put, frame.at)
