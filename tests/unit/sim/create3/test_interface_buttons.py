import pytest

from zteleop.messages import Duration, InterfaceButtons, Time
from zteleop.sim.create3.interface_buttons import NAMES, Buttons, Name


@pytest.mark.parametrize("name", NAMES)
def test_one_that_is_held_says_since_when_and_its_duration_grows(name: Name) -> None:
    buttons = Buttons()
    assert buttons.press(name, True, Time(10, 900_000_000))
    for now, held in ((Time(10, 900_000_000), Duration(0, 0)), (Time(12, 0), Duration(1, 100_000_000))):
        button = getattr(buttons.message(now), name)
        assert button.is_pressed
        assert button.last_start_pressed_time == Time(10, 900_000_000)
        assert button.last_pressed_duration == held
        assert button.header.stamp == now
    assert buttons.down == [name]


def test_one_that_was_let_go_keeps_how_long_it_was_down() -> None:
    buttons = Buttons()
    buttons.press("button_1", True, Time(10, 0))
    assert buttons.press("button_1", False, Time(13, 500_000_000))
    button = buttons.message(Time(99, 0)).button_1
    assert not button.is_pressed
    assert button.last_start_pressed_time == Time(10, 0)
    assert button.last_pressed_duration == Duration(3, 500_000_000)


def test_a_second_press_changes_nothing() -> None:
    buttons = Buttons()
    assert not buttons.press("button_2", False, Time(1, 0))
    buttons.press("button_2", True, Time(2, 0))
    assert not buttons.press("button_2", True, Time(3, 0))
    assert buttons.message(Time(5, 0)).button_2.last_pressed_duration == Duration(3, 0)


def test_all_are_up_at_the_start() -> None:
    said = Buttons().message(Time(5, 6))
    assert not said.pressed
    said.header = InterfaceButtons.zero().header
    assert said.button_1.last_start_pressed_time == Time(0, 0)


def test_a_clock_that_is_set_back_makes_no_negative_duration() -> None:
    buttons = Buttons()
    buttons.press("button_1", True, Time(10, 0))
    assert buttons.message(Time(4, 0)).button_1.last_pressed_duration == Duration(0, 0)
    buttons.press("button_1", False, Time(3, 0))
    assert buttons.message(Time(4, 0)).button_1.last_pressed_duration == Duration(0, 0)
