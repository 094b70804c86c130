"""A key that may only have been touched, and one that is known to be held."""

from zteleop.control.stick import Stick
from zteleop.inputs.holding import UNCONFIRMED, Holding
from zteleop.inputs.keymap import DIRECTIONS
from zteleop.terminal.keys import Key


def press(holding: Holding, now: float, *keys: str) -> None:
    for key in keys:
        holding.press(Key(key), DIRECTIONS[key], now)


def test_a_press_is_slow_until_a_repeat_tells_that_it_is_held() -> None:
    holding = Holding()
    press(holding, 0.0, "forward")
    assert holding.stick(0.5) == Stick(UNCONFIRMED, 0.0, deadman=True)
    press(holding, 0.5, "forward")
    assert holding.stick(0.51) == Stick(1.0, 0.0, deadman=True)


def test_wheels_steer_all_the_way_at_the_first_press_and_what_turns_on_the_spot_does_not() -> None:
    holding = Holding()
    press(holding, 0.0, "left")
    assert holding.stick(0.1) == Stick(0.0, 1.0, deadman=True)
    holding.steers = False
    assert holding.stick(0.1) == Stick(0.0, UNCONFIRMED, deadman=True)


def test_who_steers_meanwhile_is_not_slowed() -> None:
    holding = Holding()
    press(holding, 0.0, "forward")
    press(holding, 0.5, "forward")
    press(holding, 0.6, "left")
    assert holding.stick(0.7) == Stick(1.0, 1.0, deadman=True)


def test_the_other_way_and_a_later_press_begin_anew() -> None:
    holding = Holding()
    press(holding, 0.0, "forward")
    press(holding, 0.5, "forward")
    press(holding, 0.6, "reverse")
    assert holding.stick(0.61).forward == -UNCONFIRMED
    press(holding, 0.65, "reverse")
    assert holding.stick(0.66).forward == -1.0
    press(holding, 5.0, "reverse")
    assert holding.stick(5.1).forward == -UNCONFIRMED


def test_a_release_that_is_told_needs_no_such_care() -> None:
    holding = Holding()
    holding.be_told(True)
    press(holding, 0.0, "forward")
    assert holding.stick(0.1) == Stick(1.0, 0.0, deadman=True)
