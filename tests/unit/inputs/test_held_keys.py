import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.control.stick import Stick
from zteleop.inputs.held_keys import FIRST, LONGEST_GAP, SHORTEST_GAP, TOLD_FOR, Block, HeldKeys

AXES = {"up": ("forward", 1), "down": ("forward", -1), "left": ("turn", 1), "right": ("turn", -1)}
PUSHED = {"forward": "throttle", "turn": "steering"}


def press(held: HeldKeys, key: str, *times: float) -> None:
    for now in times:
        axis, sign = AXES[key]
        held.press(key, ((PUSHED[axis], sign),), now)


def repeats(start: float, end: float, delay: float = 0.5, rate: float = 30.0) -> list[float]:
    """A key held down: its press, then its repeats."""
    return [start, *(start + delay + i / rate for i in range(int((end - start - delay) * rate)))]


def test_a_tap_drives_for_the_first_time_and_no_longer():
    held = HeldKeys()
    press(held, "up", 10.0)
    assert held.stick(10.0 + FIRST - 0.01) == Stick(1.0, 0.0, True)
    assert held.stick(10.0 + FIRST) == Stick()


def test_a_held_key_drives_without_a_gap_and_stops_soon_after():
    held = HeldKeys()
    times = repeats(0.0, 3.0)
    for now, following in zip(times, [*times[1:], times[-1]], strict=True):
        press(held, "up", now)
        assert held.stick(following).forward == 1.0
    assert held.stick(times[-1] + SHORTEST_GAP - 0.01).deadman
    assert not held.stick(times[-1] + SHORTEST_GAP + 0.01).deadman


def test_repeats_end_the_first_presss_allowance():
    held = HeldKeys()
    press(held, "up", 0.0, 0.2, 0.23, 0.26)
    assert not held.stick(0.4).deadman


@pytest.mark.parametrize(("interval", "gap"), [(0.02, SHORTEST_GAP), (0.08, 0.24), (0.25, LONGEST_GAP)])
def test_the_gap_follows_the_repeat_rate_within_bounds(interval, gap):
    held = HeldKeys()
    press(held, "up", *(0.2 + i * interval for i in range(40)))
    assert held.gap == pytest.approx(gap, abs=0.02)


def test_the_last_pressed_of_an_axis_wins_at_once():
    held = HeldKeys()
    press(held, "right", *repeats(0.0, 1.0))
    press(held, "left", 1.0)
    assert held.stick(1.0).turn == 1.0


def test_the_other_axis_stays_while_the_newest_key_does():
    held = HeldKeys()
    press(held, "up", *repeats(0.0, 1.0))
    left = repeats(1.0, 3.0)
    press(held, "left", *left)
    assert held.stick(left[-1] + 0.05) == Stick(1.0, 1.0, True)
    assert held.stick(left[-1] + 0.2) == Stick()


def test_taps_of_steering_while_driving_carry_the_drive():
    held = HeldKeys()
    press(held, "up", *repeats(0.0, 1.0))
    for now, key in ((1.0, "left"), (1.5, "right"), (2.0, "left")):
        press(held, key, now)
        assert held.stick(now + 0.4).forward == 1.0
    assert held.stick(2.0 + FIRST) == Stick()


def test_a_key_that_had_lapsed_is_not_carried():
    held = HeldKeys()
    press(held, "up", 0.0)
    press(held, "left", 1.0)
    assert held.stick(1.1) == Stick(0.0, 1.0, True)


def test_cleared_is_let_go():
    held = HeldKeys()
    press(held, "up", 0.0)
    held.clear()
    assert held.stick(0.1) == Stick()
    press(held, "left", 0.2)
    assert held.stick(0.2) == Stick(0.0, 1.0, True)


@given(st.lists(st.tuples(st.sampled_from(sorted(AXES)), st.floats(0, 1)), max_size=60))
def test_any_keys_give_a_stick_in_range_that_ends_in_time(presses):
    held, now = HeldKeys(), 0.0
    for key, wait in presses:
        now += wait
        press(held, key, now)
        stick = held.stick(now)
        assert stick.deadman
        assert {stick.forward, stick.turn} <= {-1.0, 0.0, 1.0}
        assert getattr(stick, AXES[key][0]) == AXES[key][1]
    assert held.stick(now + FIRST) == Stick()


def test_a_key_held_through_a_reset_is_blocked_until_it_has_been_quiet():
    block = Block()
    assert block.passes("up", 1.0)
    block.block(1.1)
    assert not any(block.passes("up", now) for now in (1.5, 1.53, 1.56, 2.1))
    assert block.passes("up", 2.1 + FIRST)


def test_only_what_was_seen_just_before_is_blocked():
    block = Block()
    assert block.passes("up", 1.0)
    assert block.passes("left", 1.5)
    block.block(1.8)
    assert block.passes("up", 1.9)
    assert block.passes("right", 1.9)
    assert not block.passes("left", 1.9)


def test_a_blocked_key_stays_blocked_over_a_second_reset():
    block = Block()
    block.passes("up", 1.0)
    block.block(1.1)
    block.passes("up", 1.4)
    block.block(1.5)
    assert not block.passes("up", 2.05)


def test_a_press_in_vain_is_felt_until_the_key_has_been_quiet():
    block = Block()
    block.passes("up", 1.0)
    block.block(1.1)
    assert not block.is_felt(1.1)
    assert not block.passes("up", 1.4)
    assert block.is_felt(1.4 + FIRST), "as long as it takes to read it"
    assert not block.is_felt(1.4 + TOLD_FOR)
    assert block.passes("up", 1.4 + FIRST)
    assert not block.is_felt(1.4 + FIRST)
