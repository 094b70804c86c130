import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.control.stick import Stick
from zteleop.inputs.down_keys import RETURNED, DownKeys

MOVES = {
    **{"up": (("throttle", 1),), "down": (("throttle", -1),)},
    **{"left": (("steering", 1),), "right": (("steering", -1),)},
}


def held(*keys: str) -> DownKeys:
    down = DownKeys()
    for key in keys:
        down.press(key, MOVES[key], now=1.0)
    return down


@pytest.mark.parametrize(
    ("keys", "forward", "turn"),
    [(("up",), 1, 0), (("up", "right"), 1, -1), (("up", "down"), -1, 0), (("down", "up", "left"), 1, 1)],
)
def test_all_keys_that_are_down_count_and_of_one_axis_the_last(keys, forward, turn):
    assert held(*keys).stick() == Stick(forward, turn, deadman=True)


def test_when_the_later_of_two_is_let_go_the_earlier_goes_on():
    down = held("left", "right")
    down.release("right")
    assert down.stick() == Stick(0.0, 1.0, deadman=True)
    down.release("left")
    assert down.stick() == Stick()
    assert not down.any


def test_after_all_were_let_go_by_a_stop_a_key_must_be_pressed_anew():
    down = held("up")
    down.clear()
    down.release("up")
    assert down.stick() == Stick()
    down.press("up", MOVES["up"], now=2.0)
    assert down.stick().deadman


def test_what_is_pressed_just_after_the_focus_came_back_may_be_old():
    down = held("up")
    down.look_away(5.0)
    down.press("up", MOVES["up"], now=5.0 + RETURNED * 0.9)
    assert not down.any
    down.press("up", MOVES["up"], now=5.0 + RETURNED * 1.1)
    assert down.any


@given(st.lists(st.tuples(st.sampled_from([*MOVES]), st.booleans()), max_size=40))
def test_it_drives_exactly_while_a_key_is_down(events):
    down, pressed = DownKeys(), list[str]()
    for key, is_press in events:
        pressed = [other for other in pressed if other != key] + ([key] if is_press else [])
        if is_press:
            down.press(key, MOVES[key], now=1.0)
        else:
            down.release(key)
        stick = down.stick()
        assert stick.deadman == bool(pressed)
        for axis, value in (("throttle", stick.forward), ("steering", stick.turn)):
            pushes = [sign for key in pressed for pushed, sign in MOVES[key] if pushed == axis]
            assert value == [0, *pushes][-1]
