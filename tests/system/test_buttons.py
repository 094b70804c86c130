"""The buttons of a robot drive it: somebody says that they are pressed, and a process of its own obeys."""

from collections.abc import Iterator

import pytest
from rig import NEUTRAL, Process, Rig, repeating, until

from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.messages import InterfaceButtons


@pytest.fixture(scope="module")
def rig(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Rig]:
    with Rig(tmp_path_factory.mktemp("buttons")) as bench:
        bench.actuator()
        yield bench


@pytest.fixture(scope="module")
def node(rig: Rig) -> Node:
    return rig.node("robot")


@pytest.fixture
def verb(rig: Rig) -> Iterator[Process]:
    process = rig.join("buttons")
    process.says("no button is heard yet  ->  idle: nobody drives")
    yield process
    process.close()


@pytest.fixture
def said(node: Node, verb: Process) -> Publisher[InterfaceButtons]:
    publisher = node.publisher("interface_buttons", InterfaceButtons)
    until(lambda: publisher.matched, "somebody who hears of buttons")
    return publisher


def press(said: Publisher[InterfaceButtons], left: bool = False, right: bool = False) -> None:
    message = InterfaceButtons.zero()
    message.button_1.is_pressed, message.button_2.is_pressed = left, right
    said.publish(message)


def drives(rig: Rig) -> bool:
    steering, throttle = rig.ticks
    return bool(steering and throttle) and throttle > NEUTRAL[1]


def test_the_left_button_drives_until_it_is_let_go(
    rig: Rig, verb: Process, said: Publisher[InterfaceButtons]
) -> None:
    press(said)
    verb.says("neither button is down")
    with repeating(lambda: press(said, left=True), 0.1):
        until(lambda: drives(rig), "motion")
        verb.says("left: forward  ->  driving: buttons ")
    press(said)
    until(lambda: rig.ticks == NEUTRAL, "rest")


def test_the_right_one_turns_and_both_make_an_arc(
    rig: Rig, verb: Process, said: Publisher[InterfaceButtons]
) -> None:
    press(said)
    verb.says("neither button is down")
    with repeating(lambda: press(said, right=True), 0.1):
        until(lambda: rig.ticks == (460, NEUTRAL[1]), "the wheels to the left")
    with repeating(lambda: press(said, True, True), 0.1):
        until(lambda: drives(rig) and rig.ticks[0] == 460, "an arc")
    press(said)
    until(lambda: rig.ticks == NEUTRAL, "rest")


def test_buttons_that_nobody_tells_of_any_more_stop_it(
    rig: Rig, verb: Process, said: Publisher[InterfaceButtons]
) -> None:
    press(said)
    verb.says("neither button is down")
    with repeating(lambda: press(said, left=True), 0.1):
        until(lambda: drives(rig), "motion")
    until(lambda: rig.ticks == NEUTRAL, "rest, with the button still down")
    with repeating(lambda: press(said, left=True), 0.1):
        verb.says("let go of the buttons first")
        assert rig.ticks == NEUTRAL
