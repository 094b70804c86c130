"""Two buttons as a stick: what each does, and what is not a press."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.control.stick import Stick
from zteleop.inputs.buttons import LOST_AFTER, Buttons
from zteleop.messages import InterfaceButtons

NEITHER, LEFT, RIGHT, BOTH = (False, False), (True, False), (False, True), (True, True)


def said(left: bool, right: bool) -> InterfaceButtons:
    message = InterfaceButtons.zero()
    message.button_1.is_pressed, message.button_2.is_pressed = left, right
    return message


@pytest.fixture
def buttons() -> Buttons:
    buttons = Buttons()
    buttons.hear(said(*NEITHER), 0.0)
    return buttons


@pytest.mark.parametrize(
    ("down", "stick", "words"),
    [
        (NEITHER, Stick(), "neither button is down"),
        (LEFT, Stick(1.0, 0.0, True), "left: forward"),
        (RIGHT, Stick(0.0, 1.0, True), "right: turns left"),
        (BOTH, Stick(1.0, 1.0, True), "both: an arc to the left"),
    ],
)
def test_each_button_has_its_direction(
    buttons: Buttons, down: tuple[bool, bool], stick: Stick, words: str
) -> None:
    buttons.hear(said(*down), 1.0)
    assert buttons.read(1.0) == stick.deadman
    assert buttons.stick(1.0) == stick
    assert buttons.about == [words]


def test_a_button_is_held_until_the_robot_says_otherwise(buttons: Buttons) -> None:
    buttons.hear(said(*LEFT), 1.0)
    assert [buttons.read(1.0 + tenth / 10) for tenth in range(15)] == [True] * 15
    buttons.hear(said(*NEITHER), 2.5)
    assert (buttons.read(2.5), buttons.stick(2.5).deadman, buttons.rested) == (False, False, True)


def test_buttons_that_nobody_tells_of_any_more_are_up_and_must_be_let_go(buttons: Buttons) -> None:
    buttons.hear(said(*LEFT), 1.0)
    assert buttons.read(1.0 + LOST_AFTER)
    assert not buttons.read(1.01 + LOST_AFTER)
    assert buttons.stick(3.0) == Stick()
    assert buttons.about == ["the buttons are no longer heard"]
    buttons.hear(said(*LEFT), 4.0)
    assert not buttons.read(4.0)
    assert buttons.about == ["let go of the buttons first"]
    buttons.hear(said(*NEITHER), 4.1)
    buttons.hear(said(*LEFT), 4.2)
    assert buttons.read(4.2)


def test_what_is_down_at_the_start_does_not_count() -> None:
    buttons = Buttons()
    assert buttons.about == ["no button is heard yet"]
    assert not buttons.read(0.0)
    buttons.hear(said(*BOTH), 0.1)
    assert (buttons.read(0.1), buttons.stick(0.1)) == (False, Stick())


def test_after_a_reset_a_button_counts_once_let_go(buttons: Buttons) -> None:
    buttons.hear(said(*RIGHT), 1.0)
    buttons.reset(1.0)
    buttons.hear(said(*RIGHT), 1.1)
    assert not buttons.read(1.1)
    buttons.hear(said(*NEITHER), 1.2)
    buttons.hear(said(*RIGHT), 1.3)
    assert buttons.read(1.3)


@given(st.lists(st.tuples(st.floats(0, 3), st.none() | st.tuples(st.booleans(), st.booleans()))))
def test_nothing_is_held_that_was_not_seen_up_and_then_down(
    steps: list[tuple[float, tuple[bool, bool] | None]],
) -> None:
    buttons, now, armed, last = Buttons(), 0.0, False, float("-inf")
    for pause, down in steps:
        now += pause
        held = buttons.read(now)
        if now - last > LOST_AFTER:
            armed = False
        assert not held or armed
        if down is not None:
            buttons.hear(said(*down), now)
            armed, last = armed or down == NEITHER, now
