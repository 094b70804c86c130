"""An inbox and its pump, with the ring in the test's hands and no thread."""

import pytest
from unit.bus.fakes import Ring, Sample, put, sample

from zteleop.bus import codec
from zteleop.bus.lag import LAGS_AFTER, Lag
from zteleop.bus.subscription import Received, Subscription
from zteleop.control.proof import Proof
from zteleop.messages import Pwm, String
from zteleop.testing import Clock

PROOF = Proof(1, 2, 3, 4.0, 5.0, 6.0)


class Inbox:
    """A subscription to texts, its ring, and what it complained of."""

    def __init__(self, *samples: Sample) -> None:
        self.ring, self.complaints = Ring(*samples), []
        self.subscription: Subscription[String] = Subscription(
            self.ring, codec.decoders([String]), self.complaints.append, lag=Lag(self.complaints.append)
        )

    def read(self, sample: Sample) -> Received[String] | None:
        return self.subscription.read(sample)


@pytest.fixture
def inbox(clock: Clock) -> Inbox:
    return Inbox()


def test_a_message_is_read_with_its_key_and_when_it_was(inbox: Inbox, clock: Clock) -> None:
    at_the_door = clock.time - 0.25
    received = inbox.read(sample(String("hello"), "robot/archangel/cmd_vel/web")._replace(at=at_the_door))
    assert received == (String("hello"), "robot/archangel/cmd_vel/web", None, clock.time, at_the_door)
    assert received.source == "web"
    assert (inbox.subscription.dropped, inbox.complaints) == (0, [])


def test_a_proof_is_read_from_the_attachment(inbox: Inbox) -> None:
    assert inbox.read(sample(String("x"), attachment=codec.pack_proof(PROOF))).proof == PROOF


@pytest.mark.parametrize("attachment", [None, b"", b"a letter", bytes(49)])
def test_any_other_attachment_is_no_proof(inbox: Inbox, attachment: bytes | None) -> None:
    assert inbox.read(sample(String("x"), attachment=attachment)).proof is None
    assert inbox.complaints == []


@pytest.mark.parametrize(
    ("bad", "words"),
    [
        (put(b'{"data":"x"}', is_put=False), "a delete or a wildcard is no message"),
        (put(b'{"data":"x"}', key="robot/*/chatter"), "a delete or a wildcard is no message"),
        (put(b'{"data":"x"}', key="robot/**"), "a delete or a wildcard is no message"),
        (sample(Pwm(1, 2)), "expected std_msgs/msg/String, found 'zteleop_msgs/msg/Pwm'"),
        (put(b"{}"), "not a std_msgs/msg/String: Object missing required field `data`"),
        (
            put(b'{"data":"x"}', encoding="zenoh/bytes"),
            "expected std_msgs/msg/String, found",
        ),
    ],
    ids=["delete", "one wildcard", "all wildcards", "another type", "no such message", "no encoding"],
)
def test_what_is_no_message_is_dropped_counted_and_said(inbox: Inbox, bad: Sample, words: str) -> None:
    for count in (1, 2):
        assert inbox.read(bad) is None
        assert inbox.subscription.dropped == count
        assert inbox.complaints[-1].startswith(f"{bad.key}: dropped: {words}")


def test_take_empties_the_ring_and_leaves_out_what_is_no_message() -> None:
    inbox = Inbox(sample(String("a")), put(b"{}"), sample(String("b")))
    assert [received.message.data for received in inbox.subscription.take()] == ["a", "b"]
    assert inbox.subscription.dropped == 1
    assert not inbox.ring.samples


def test_newest_is_the_last_since_the_last_look() -> None:
    inbox = Inbox(sample(String("a")), sample(String("b")))
    assert inbox.subscription.newest() == String("b")
    assert inbox.subscription.newest() is None


def test_a_bad_message_does_not_hide_the_one_before() -> None:
    inbox = Inbox(sample(String("a")), put(b"{}"))
    assert inbox.subscription.newest() == String("a")


def test_iteration_ends_with_the_session() -> None:
    inbox = Inbox(sample(String("a")), put(b"{}"), sample(String("b")))
    assert list(inbox.subscription) == [String("a"), String("b")]


def lagging(pause: float, clock: Clock, messages: int = 40) -> list[str]:
    inbox = Inbox(*[sample(String("a"))] * messages)
    for _ in inbox.subscription:
        clock.pass_by(pause)
    return inbox.complaints


def test_a_program_that_is_slower_than_what_it_hears_is_told_so(clock: Clock) -> None:
    assert lagging(0.1, clock, messages=int(LAGS_AFTER / 0.1) + 3) == [
        "messages come faster than this program takes them (10 a second): "
        "they wait, and the oldest are lost once too many do"
    ]


def test_messages_that_waited_for_a_moment_are_nothing_to_tell(clock: Clock) -> None:
    assert lagging(LAGS_AFTER / 50, clock) == []


def test_only_messages_that_wait_without_end_are_told(clock: Clock) -> None:
    lag, told = (inbox := Inbox()).subscription.lag, inbox.complaints
    for _ in range(5):
        lag.goes_on()
        clock.pass_by(0.6 * LAGS_AFTER)
        lag.is_over()
        clock.pass_by(0.6 * LAGS_AFTER)
    assert told == []
