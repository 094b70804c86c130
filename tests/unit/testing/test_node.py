"""The fakes keep to the faces of what they stand for, and time passes as a test says."""

import inspect
from typing import Any

import pytest

from zteleop.bus.loop import Loop
from zteleop.bus.membership import Membership
from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.bus.subscription import Subscription
from zteleop.drivers import PulseDriver
from zteleop.messages import String
from zteleop.terminal.terminal import Terminal
from zteleop.testing import FakeNode, FakeTerminal, Inbox, Link, MemoryChip, Said
from zteleop.testing.loop import FakeLoop
from zteleop.testing.node import FakeMembership


def face(kind: type) -> dict[str, list[tuple[str, object, object]]]:
    """Return the parameters of each public method: name, kind, default."""
    return {
        name: [(p.name, p.kind, p.default) for p in inspect.signature(member).parameters.values()]
        for name, member in inspect.getmembers(kind, inspect.isfunction)
        if not name.startswith("_")
    }


@pytest.mark.parametrize(
    ("real", "fake", "leaves_out"),
    [
        (Node, FakeNode, set()),
        (PulseDriver, MemoryChip, set()),
        (Terminal, FakeTerminal, {"size", "draw"}),
        (Publisher, Said, {"leave"}),
        (Subscription, Inbox, {"read"}),
        (Loop, FakeLoop, {"call_soon", "call_next", "fail", "close", "run", "run_once"}),
        (Membership, FakeMembership, set(face(Membership)) - {"heard", "departures", "until"}),
    ],
)
def test_a_fake_can_be_called_like_the_real_one(real: type, fake: type, leaves_out: set[str]) -> None:
    expected = {name: parameters for name, parameters in face(real).items() if name not in leaves_out}
    assert {name: face(fake).get(name) for name in expected} == expected


def test_timers_run_when_they_are_due_until_it_is_stopped() -> None:
    node, log = FakeNode(), []

    @node.every(1.0)
    def second() -> None:
        log.append(("second", node.loop.clock.time))

    @node.every(0.4)
    def other() -> None:
        log.append(("other", round(node.loop.clock.time, 3)))
        if len(log) >= 5:
            node.stop()

    began = node.loop.clock.time
    node.live(10.0)
    assert [(name, round(time - began, 3)) for name, time in log] == [
        ("second", 0.0),
        ("other", 0.0),
        ("other", 0.4),
        ("other", 0.8),
        ("second", 1.0),
        ("other", 1.2),
    ]
    assert node.stopped


def test_what_is_due_at_the_same_time_does_not_run_once_it_is_stopped() -> None:
    node, log = FakeNode(), []
    node.every(1.0)(node.stop)
    node.every(1.0)(lambda: log.append("ran"))
    node.live(5.0)
    assert log == []


def test_an_alarm_rings_once_when_it_is_told_to() -> None:
    node, rung = FakeNode(), []
    alarm = node.loop.alarm(lambda: rung.append(node.loop.clock.time))
    node.live(1.0)
    assert rung == []
    alarm.ring_at(node.loop.clock.time + 0.5)
    node.live(2.0)
    assert rung == [1001.5]


def test_what_it_hears_goes_to_its_handler_or_waits() -> None:
    node, heard = FakeNode(link=Link(repeat=2)), []
    node.on("chatter", String)(heard.append)
    inbox: Any = node.subscription("words", String)
    for text in "ab":
        node.hear("chatter", String(text))
        node.hear("words", String(text))
    assert [message.data for message in heard] == ["a", "b"]
    assert [message.data for message in inbox] == ["a", "a", "b", "b"]


def test_each_function_for_a_topic_hears_it() -> None:
    node, heard = FakeNode(), []
    for _ in range(2):
        node.on("chatter", String)(heard.append)
    node.hear("chatter", String("a"))
    assert [message.data for message in heard] == ["a", "a"]


def test_what_it_says_is_kept_with_its_acts() -> None:
    node = FakeNode()
    publisher = node.publisher("chatter", String)
    publisher.publish(String("a"))
    publisher.repeat(String("b"))
    assert [message.data for message in node.said["chatter"].take()] == ["a", "b"]
    assert (publisher.acts, publisher.take()) == (1, [])


def test_until_lets_time_pass_and_gives_up() -> None:
    node = FakeNode()
    now = node.loop.clock.time
    assert not node.membership.until(lambda: False, 1.0)
    assert node.loop.clock.time == pytest.approx(now + 1.0, abs=0.02)
    assert node.membership.until(lambda: "found", 1.0) == "found"
