"""The door's end: does with zenoh what the robot's own processes ask for, and passes on what arrives.

What arrives comes in a thread of zenoh's and is passed on there and then: one hop, and nothing of it waits
for what these processes ask. It never waits for them either.
"""

import socket
import threading
from collections.abc import Callable
from contextlib import suppress
from itertools import count

from zteleop.bus import clock
from zteleop.bus.door.backlog import Backlog
from zteleop.bus.door.frames import (
    Advertise,
    Answer,
    Arrived,
    Ask,
    Asked,
    AskTokens,
    Hello,
    Put,
    Replied,
    Serve,
    Stand,
    Subscribe,
    Tokens,
    Undeclare,
    WatchTokens,
)
from zteleop.bus.door.hub import Hub
from zteleop.bus.door.wire import Wire
from zteleop.bus.loop import Loop
from zteleop.bus.session import Outlet, Question, Sample, Undeclarable
from zteleop.bus.zenoh_session import ZenohSession
from zteleop.control.allowance import Allowance
from zteleop.errors import BusError
from zteleop.machine import signals
from zteleop.machine.ids import new_id

AT_ONCE, EVERY, EVERY_PROVEN = 500, 0.001, 0.0002
"""samples of one key, and s until there may be one more: a flood costs the robot this much and no more. What
comes with a proof counts apart, so that nothing without one takes a command's place"""
WAITING = 2**22
"""bytes that wait for a process that reads nothing; what comes after them is lost"""
FLUSH_EVERY = 0.01
"""s between two attempts to pass on what waits"""
QUESTIONS_AT_ONCE, QUESTION_EVERY = 20, 0.05
"""of one key, and s until there may be one more; who asks besides is refused here"""
TOO_MANY = "it is asked too often; ask again later"
UNANSWERED = 5.0
"""s after which a question is forgotten"""


class Host:
    """Lets the robot's own processes in, at a socket that outlives this process."""

    def __init__(
        self, session: ZenohSession, listener: socket.socket, loop: Loop, complain: Callable[[str], object]
    ) -> None:
        self._session = session
        self._hub = Hub(session)
        self._listener = listener
        self._loop = loop
        self._complain = complain
        self._guests: list[Guest] = []
        listener.setblocking(False)
        loop.watch(listener.fileno(), self._let_in)
        self._flusher = loop.alarm(self._flush)
        self._flush_is_due = False
        loop.every(UNANSWERED, self._forget)

    def _let_in(self) -> None:
        with suppress(BlockingIOError):
            while True:
                end, _ = self._listener.accept()
                guest = Guest(self._session, self._hub, Wire(end, Ask), self._complain, self._flush_soon)
                self._guests.append(guest)
                self._loop.watch(guest.fileno(), lambda guest=guest: self._serve(guest))  # type: ignore[misc]
                guest.greet()

    def _serve(self, guest: "Guest") -> None:
        try:
            guest.serve()
        except EOFError:
            self._guests.remove(guest)
            self._loop.unwatch(guest.fileno())
            guest.leave()

    def _flush_soon(self) -> None:
        """Pass on a little later what a guest does not take now; safe from any thread."""
        if not self._flush_is_due:
            self._flush_is_due = True
            self._loop.call_soon(lambda: self._flusher.ring_at(clock.now() + FLUSH_EVERY))

    def _flush(self) -> None:
        self._flush_is_due = False  # before it is done: what comes meanwhile asks anew
        done = [guest.flush() for guest in self._guests]
        if not all(done):
            self._flush_soon()

    def _forget(self) -> None:
        for guest in self._guests:
            guest.forget(clock.now())


class Guest:
    """One of the robot's own processes, and what it has declared."""

    def __init__(
        self,
        session: ZenohSession,
        hub: Hub,
        wire: Wire[Ask],
        complain: Callable[[str], object],
        flush_soon: Callable[[], object],
    ) -> None:
        self._session = session
        self._hub = hub
        self._wire = wire
        self._complain = complain
        self._flush_soon = flush_soon
        self._declared: dict[int, Undeclarable] = {}
        self._outlets: dict[int, Outlet] = {}
        self._waiting: Backlog[Arrived | Asked] = Backlog(WAITING)
        self._passing = threading.Lock()
        self._questions: dict[int, tuple[float, Question]] = {}
        """which wait for an answer, and since when"""
        self._numbers = count(new_id())  # an answer to another door's question is none here

    def fileno(self) -> int:
        return self._wire.fileno()

    def greet(self) -> None:
        """Say that the door is open."""
        self._send(Hello(), keep=True)

    def serve(self) -> None:
        """Do what was asked; raises EOFError when the process is gone."""
        for ask in self._wire.read():
            try:
                self._do(ask)
            except BusError as error:  # zenoh takes no such name, or nothing any more
                self._complain(f"the door cannot do what it is asked: {error}")

    def flush(self) -> bool:
        """Pass on what had to wait; True when nothing waits any more."""
        self._wire.flush()
        with self._passing:
            while self._waiting and self._wire.send(self._waiting.next):
                self._waiting.drop()
            return not self._waiting and not self._wire.lags

    def forget(self, now: float) -> None:
        """Give up what is not answered."""
        for number, (since, _) in list(self._questions.items()):
            if now - since > UNANSWERED:
                self._questions.pop(number, None)

    def leave(self) -> None:
        """Take back all that it declared."""
        for declared in self._declared.values():
            declared.undeclare()
        self._wire.close()

    def _do(self, ask: Ask) -> None:
        if isinstance(ask, Put):
            if outlet := self._outlets.get(ask.id):
                outlet.put(ask.payload, ask.encoding, ask.attachment)
        elif isinstance(ask, Subscribe):
            self._declared[ask.id] = self._hub.hear(ask.key, ask.depth, self._passer(ask.id))
        elif isinstance(ask, WatchTokens):
            self._declared[ask.id] = self._session.hear_tokens(
                ask.selector, self._passer(ask.id), ask.history
            )
        elif isinstance(ask, Advertise):
            outlet = self._outlets[ask.id] = self._session.advertise(ask.key, ask.urgent)
            self._declared[ask.id] = outlet
        elif isinstance(ask, Stand):
            self._declared[ask.id] = self._session.stand(ask.key)
        elif isinstance(ask, Serve):
            self._declared[ask.id] = self._session.heed(ask.key, self._asker(ask.id))
        elif isinstance(ask, Replied):
            self._reply(ask)
        elif isinstance(ask, Undeclare):
            self._outlets.pop(ask.id, None)
            if declared := self._declared.pop(ask.id, None):
                declared.undeclare()
        else:
            signals.start(threading.Thread(target=self._look_up, args=(ask,), daemon=True))

    def _passer(self, identity: int) -> Callable[[Sample], None]:
        """Return what passes samples on; zenoh calls it in threads of its own."""
        bare, proven = Allowance(AT_ONCE, EVERY), Allowance(AT_ONCE, EVERY_PROVEN)

        def passes(sample: Sample) -> None:
            now = clock.now()
            allowance = bare if sample.attachment is None else proven
            if allowance.has(now):
                allowance.spend(now)
                self._pass(Arrived(identity, *sample[:-1], at=now))

        return passes

    def _asker(self, identity: int) -> Callable[[Question], None]:
        """Return what passes questions on; zenoh calls it in threads of its own."""
        allowance = Allowance(QUESTIONS_AT_ONCE, QUESTION_EVERY)

        def asks(question: Question) -> None:
            now = clock.now()
            if not allowance.has(now):
                question.refuse(TOO_MANY)
                return
            allowance.spend(now)
            number = next(self._numbers)
            self._questions[number] = now, question
            self._pass(Asked(identity, number, question.payload, question.encoding))

        return asks

    def _reply(self, replied: Replied) -> None:
        _, question = self._questions.pop(replied.question, (0.0, None))
        if question and replied.refused:
            question.refuse(replied.payload.decode(errors="replace"))
        elif question:
            question.answer(replied.payload, replied.encoding)

    def _pass(self, arrived: Arrived | Asked) -> None:
        # Of one key what has a proof waits apart: no flood without one comes before it.
        kind = (arrived.id, isinstance(arrived, Arrived) and arrived.attachment is not None)
        with self._passing:
            if self._waiting.has(kind) or not self._send(arrived):
                self._waiting.add(kind, arrived, len(arrived.payload))

    def _send(self, frame: Answer, keep: bool = False) -> bool:
        """Say a frame as far as the process takes it, the rest soon; False when it takes nothing."""
        sent = self._wire.send(frame, keep=keep)
        if not sent or self._wire.lags:
            self._flush_soon()
        return sent

    def _look_up(self, ask: AskTokens) -> None:
        """Ask the bus, which may take its time."""
        with suppress(BusError):
            self._send(Tokens(ask.id, sorted(self._session.tokens(ask.selector))), keep=True)
