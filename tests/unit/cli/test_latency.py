import argparse
from collections.abc import Callable
from contextlib import nullcontext

import pytest
from unit.screen.boards import status

from zteleop.bus.subscription import Received
from zteleop.cli import latency
from zteleop.errors import BusError
from zteleop.messages import GetTimeResponse, Hop, Latency, Message, Time
from zteleop.testing import Clock, FakeNode

KEYBOARD = Latency("keyboard 18d4", [Hop("act to bus", 5, 0.0004, 0.0009)])
ROBOT = Latency(
    "actuator", [Hop("door to actuator", 20, 0.0001, 0.001), Hop("actuator to chip", 20, 0.0003, 0.002)]
)
Tell = Callable[..., list[str]]


@pytest.fixture
def node(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> FakeNode:
    node = FakeNode(clock=clock)

    def answer(request: Message) -> GetTimeResponse:
        clock.pass_by(0.0004)
        return GetTimeResponse(Time(0, 0))

    node.services["/archangel/actuator/get_time"] = answer
    monkeypatch.setattr(latency._options, "load_anyhow", lambda arguments: None)
    monkeypatch.setattr(latency._options, "join", lambda name, settings: nullcontext(node))
    monkeypatch.setattr("zteleop.bus.presence.robots", lambda session: ["archangle"])
    return node


@pytest.fixture
def tell(node: FakeNode, clock: Clock, capsys: pytest.CaptureFixture[str]) -> Tell:
    """Say something a moment before the end of a second, and return what is printed, in columns."""

    def tell(**said: Message) -> list[str]:
        def spin() -> None:
            node.loop.live(0.9)
            for topic, message in said.items():
                about = "latency" if isinstance(message, Latency) else topic
                node.inboxes[about].handler(Received(message, f"robot/archangel/{about}", None, clock.time))
            node.loop.live(0.2)

        node.spin = spin
        latency.run(argparse.Namespace(once=True))
        head, *lines = capsys.readouterr().out.splitlines()
        assert (
            " ".join(head.split())
            == "archangel, ms act to bus network door to actuator actuator to chip in all at worst"
        )
        assert {len(line) for line in lines} == {len(head)}, "the figures stand below their names"
        return lines

    return tell


def test_a_key_is_followed_from_the_act_to_the_chip(tell: Tell) -> None:
    """A question there and back takes 0.4 ms, of which each way 0.1 ms are behind the door."""
    driving = status(source="keyboard", operator="a00018d4")
    (line,) = tell(drive_status=driving, keyboard=KEYBOARD, robot=ROBOT)
    assert " ".join(line.split()) == "keyboard 18d4 0.40 0.10 0.10 0.30 0.90 4.10"


def test_of_a_program_nobody_knows_when_it_acted(tell: Tell) -> None:
    driving = status(source="program", operator="7")
    (line,) = tell(drive_status=driving, keyboard=KEYBOARD, robot=ROBOT)
    assert " ".join(line.split()) == "program 0007 - 0.10 0.10 0.30 0.50 3.20", (
        "another's keyboard is not its own"
    )


def test_where_nobody_drives_the_network_is_measured_and_nothing_else_told(tell: Tell) -> None:
    (line,) = tell(drive_status=status(operator=""), robot=ROBOT)
    assert " ".join(line.split()) == "nobody drives - 0.20 - - - -"


def test_what_was_told_of_a_while_ago_is_not_of_this_second(
    node: FakeNode, clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    def spin() -> None:
        for topic, message in (("drive_status", status()), ("latency", ROBOT)):
            node.inboxes[topic].handler(Received(message, f"robot/archangel/{topic}", None, clock.time))
        node.loop.live(3.1)
        node.stop()

    node.spin = spin
    latency.run(argparse.Namespace(once=False))
    lines = [" ".join(line.split()) for line in capsys.readouterr().out.splitlines()]
    assert lines[1].startswith("keyboard b1c0 - 0.10 0.10 0.30 ")
    assert lines[3] == "keyboard b1c0 - 0.20 - - - -"


@pytest.mark.parametrize("once", [True, False])
def test_a_robot_that_is_not_heard_is_an_error_in_words(
    node: FakeNode, once: bool, capsys: pytest.CaptureFixture[str]
) -> None:
    del node.services["/archangel/actuator/get_time"]
    node.spin = lambda: node.loop.live(latency.HEARD_WITHIN + 1.0)
    words = r"no actuator of archangel is heard within 2 s; is it on\? .*archangle"
    with pytest.raises(BusError, match=words):
        latency.run(argparse.Namespace(once=once))
    assert len(capsys.readouterr().out.splitlines()) == 1, "and no line says that nobody drives it"


def test_a_robot_that_answers_no_question_but_says_what_it_does_is_heard(tell: Tell, node: FakeNode) -> None:
    del node.services["/archangel/actuator/get_time"]
    (line,) = tell(drive_status=status(source="keyboard", operator="18d4"), keyboard=KEYBOARD, robot=ROBOT)
    assert " ".join(line.split()) == "keyboard 18d4 0.40 - 0.10 0.30 - -", "and what is not known is no sum"
