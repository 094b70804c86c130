"""The door's end: does with zenoh what the robot's own processes ask for, and passes on what arrives.

What arrives comes in a thread of zenoh's and is passed on there and then: one hop, and nothing of it waits
for what these processes ask. It never waits for them either.
"""

import socket
import threading
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from itertools import count

from zteleop.bus import clock
from zteleop.bus.door.frames import (
    Advertise,
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
from zteleop.bus.door.wire import Wire
from zteleop.bus.loop import Loop
from zteleop.bus.session import Outlet, Question, Sample
from zteleop.bus.zenoh_session import Undeclarable, ZenohSession
from zteleop.control.allowance import Allowance
from zteleop.errors import BusError
from zteleop.machine.ids import new_id

AT_ONCE, EVERY, EVERY_PROVEN = 500, 0.001, 0.0002
"""samples of one key, and s until there may be one more: a flood costs the robot this much and no more. What
comes with a proof counts apart, so that nothing without one takes a command's place"""
WAITING = 2**22
"""bytes that wait for a process that reads nothing; what comes after them is lost"""
FLUSH_EVERY = 0.02
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
        self._listener = listener
        self._loop = loop
        self._complain = complain
        self._guests: list[Guest] = []
        listener.setblocking(False)
        loop.watch(listener.fileno(), self._let_in)
        loop.every(FLUSH_EVERY, self._flush)

    def _let_in(self) -> None:
        with suppress(BlockingIOError):
            while True:
                end, _ = self._listener.accept()
                guest = Guest(self._session, Wire(end, Ask), self._complain)
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

    def _flush(self) -> None:
        for guest in self._guests:
            guest.flush()
            guest.forget(clock.now())


class Guest:
    """One of the robot's own processes, and what it has declared."""

    def __init__(self, session: ZenohSession, wire: Wire[Ask], complain: Callable[[str], object]) -> None:
        self._session = session
        self._wire = wire
        self._complain = complain
        self._declared: dict[int, Undeclarable] = {}
        self._outlets: dict[int, Outlet] = {}
        self._waiting: deque[Arrived | Asked] = deque()
        self._waiting_bytes = 0
        self._passing = threading.Lock()
        self._questions: dict[int, tuple[float, Question]] = {}
        """which wait for an answer, and since when"""
        self._numbers = count(new_id())  # an answer to another door's question is none here

    def fileno(self) -> int:
        return self._wire.fileno()

    def greet(self) -> None:
        """Say that the door is open."""
        self._wire.send(Hello(), keep=True)

    def serve(self) -> None:
        """Do what was asked; raises EOFError when the process is gone."""
        for ask in self._wire.read():
            try:
                self._do(ask)
            except BusError as error:  # zenoh takes no such name, or nothing any more
                self._complain(f"the door cannot do what it is asked: {error}")

    def flush(self) -> None:
        """Pass on what had to wait."""
        self._wire.flush()
        with self._passing:
            while self._waiting and self._wire.send(self._waiting[0]):
                self._waiting_bytes -= len(self._waiting.popleft().payload)

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
            self._declared[ask.id] = self._session.hear(ask.key, self._passer(ask.id))
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
            threading.Thread(target=self._look_up, args=(ask,), daemon=True).start()

    def _passer(self, identity: int) -> Callable[[Sample], None]:
        """Return what passes samples on; zenoh calls it in threads of its own."""
        bare, proven = Allowance(AT_ONCE, EVERY), Allowance(AT_ONCE, EVERY_PROVEN)

        def passes(sample: Sample) -> None:
            now = clock.now()
            allowance = bare if sample.attachment is None else proven
            if allowance.has(now):
                allowance.spend(now)
                self._pass(Arrived(identity, *sample))

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
        with self._passing:
            if not self._waiting and self._wire.send(arrived):
                return
            if self._waiting_bytes < WAITING:
                self._waiting.append(arrived)
                self._waiting_bytes += len(arrived.payload)

    def _look_up(self, ask: AskTokens) -> None:
        """Ask the bus, which may take its time."""
        with suppress(BusError):
            self._wire.send(Tokens(ask.id, sorted(self._session.tokens(ask.selector))), keep=True)
