"""A pump, with the ring in the test's hands and no thread."""

import threading
from collections.abc import Callable

import pytest
from unit.bus.fakes import Ring, Sample, put, sample

from zteleop.bus import codec
from zteleop.bus.lag import Lag
from zteleop.bus.loop import Loop
from zteleop.bus.pump import Pump
from zteleop.bus.subscription import Subscription
from zteleop.messages import String
from zteleop.testing import Clock


class Inbox:
    """A subscription to texts, and its ring."""

    def __init__(self, *samples: Sample) -> None:
        self.ring = Ring(*samples)
        self.subscription: Subscription[String] = Subscription(
            self.ring, codec.decoders([String]), lambda text: None
        )


class Lock:
    """A threading.Lock that tells instead of waiting."""

    def __init__(self) -> None:
        self.held = False

    def acquire(self, blocking: bool = True) -> bool:
        assert not (blocking and self.held), "waits for ever"
        free, self.held = not self.held, True
        return free

    def release(self) -> None:
        if not self.held:
            raise RuntimeError("release unlocked lock")
        self.held = False


class Thread:
    """A thread whose work is done when the test says so."""

    def __init__(self, target: Callable[[], None], name: str, daemon: bool) -> None:
        assert daemon
        self.run, self.started = target, False

    def start(self) -> None:
        self.started = True

    def join(self) -> None:
        pass


@pytest.fixture
def threads(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(threading, "Thread", Thread)
    monkeypatch.setattr(threading, "Lock", Lock)


class Obedient:
    """A loop that runs at once what it is called for."""

    def __init__(self) -> None:
        self.next: Callable[[], object] | None = None
        self.failure: BaseException | None = None

    def fail(self, error: BaseException) -> None:
        self.failure = error

    def call_soon(self, action: Callable[[], object]) -> None:
        self.next = action
        while action := self.next:
            self.next = None
            action()

    def call_next(self, action: Callable[[], object]) -> None:
        self.next = action


@pytest.mark.usefixtures("threads", "clock")
class TestPump:
    def test_a_sample_that_wakes_the_pump_is_handled_in_the_loop(self) -> None:
        inbox, heard = Inbox(sample(String("a"))), []
        loop = Loop(before_each=lambda: heard.append("look"))
        pump = Pump(inbox.subscription, lambda received: heard.append(received.message.data), loop)
        assert pump._thread.started
        with pytest.raises(AssertionError, match="waits for ever"):
            pump._wait()
        assert heard == []
        inbox.ring.samples.append(sample(String("b")))
        loop.run_once()
        assert heard == ["look", "a"]
        assert pump._emptied.held
        loop.run_once()
        assert heard == ["look", "a", "look", "b"]
        assert not pump._emptied.held
        loop.close()

    def test_a_flood_is_one_message_a_round(self) -> None:
        inbox, heard = Inbox(*(sample(String(str(number))) for number in range(9))), []
        loop = Obedient()
        pump = Pump(inbox.subscription, lambda received: heard.append(received.message.data), loop)
        pump._sample = inbox.ring.recv()
        for number in range(4):
            pump._hand_over()
            assert heard[number:] == [str(number)]
        assert loop.next == pump._hand_over
        assert pump._emptied.held

    def test_a_handler_that_is_too_slow_is_told(self, clock: Clock) -> None:
        inbox, told = Inbox(*(sample(String("a")) for _ in range(9))), []
        inbox.subscription.lag = Lag(told.append)
        pump = Pump(inbox.subscription, lambda received: clock.pass_by(0.3), Obedient())
        pump._sample = inbox.ring.recv()
        for _ in range(4):
            pump._hand_over()
        assert told == []
        pump._hand_over()
        assert "(3.3 a second)" in told[0]

    def test_a_handler_that_keeps_up_is_not(self, clock: Clock) -> None:
        inbox, told = Inbox(), []
        inbox.subscription.lag = Lag(told.append)
        pump = Pump(inbox.subscription, lambda received: clock.pass_by(0.3), Obedient())
        for _ in range(9):
            pump._sample = sample(String("a"))
            inbox.ring.samples.append(sample(String("b")))
            pump._hand_over()
            pump._hand_over()
        assert told == []

    def test_what_is_no_message_takes_its_turn_too(self) -> None:
        inbox, heard = Inbox(*[put(b"{}")] * 9), []
        pump = Pump(inbox.subscription, heard.append, Obedient())
        pump._sample = inbox.ring.recv()
        pump._hand_over()
        assert (heard, inbox.subscription.dropped) == ([], 1)

    def test_it_goes_round_until_the_session_is_closed(self) -> None:
        inbox, heard = Inbox(*(sample(String(str(number))) for number in range(9))), []
        Pump(
            inbox.subscription, lambda received: heard.append(received.message.data), Obedient()
        )._thread.run()
        assert heard == [str(number) for number in range(9)]

    def test_an_error_in_a_handler_does_not_end_the_pump(self) -> None:
        inbox = Inbox(sample(String("a")))
        pump = Pump(inbox.subscription, lambda received: 1 / 0, Obedient())
        pump._sample = inbox.ring.recv()
        with pytest.raises(ZeroDivisionError):
            pump._hand_over()
        assert not pump._emptied.held

    def test_its_thread_hands_over_what_comes(self) -> None:
        inbox, told = Inbox(sample(String("a"))), []
        handler = lambda received: told.append(received.message.data)  # noqa: E731
        Pump(inbox.subscription, handler, Obedient())._thread.run()
        assert told == ["a"]

    def test_after_a_close_it_waits_for_nobody(self) -> None:
        inbox = Inbox()
        pump = Pump(inbox.subscription, pytest.fail, Obedient())
        pump.close()
        pump._thread.run()

    def test_a_close_just_after_a_sample_came_does_not_hang(self) -> None:
        """Node.close closes the session, then each pump: the last sample may be in the pump's hand."""
        inbox = Inbox(sample(String("a")))
        pump = Pump(inbox.subscription, pytest.fail, Loop(before_each=pytest.fail))

        def receive() -> Sample:
            got = Ring.recv(inbox.ring)
            pump.close()
            return got

        inbox.ring.recv = receive
        try:
            pump._thread.run()
        finally:
            pump._loop.close()

    def test_an_error_of_its_own_ends_the_loop_for_nobody_else_would_empty_the_inbox(self) -> None:
        inbox, loop = Inbox(), Obedient()
        inbox.ring.recv = lambda: 1 / 0
        Pump(inbox.subscription, pytest.fail, loop)._thread.run()
        assert isinstance(loop.failure, ZeroDivisionError)
