from math import inf, isfinite, nan

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from zteleop.control.create3 import MAX_TURN, TRACK
from zteleop.messages import Twist
from zteleop.sim.create3.wheels import STILL, Wheels, wanted

SAFE = 0.306
numbers = st.floats(allow_nan=True, allow_infinity=True)


def body(pair: tuple[float, float]) -> tuple[float, float]:
    """Return speed and turn of two wheels."""
    return sum(pair) / 2, (pair[1] - pair[0]) / TRACK


@pytest.mark.parametrize(("asked", "given"), [(0.1, 0.1), (0.3, 0.3), (0.5, 0.306), (-0.7, -0.306)])
def test_no_wheel_is_faster_than_its_limit(asked: float, given: float) -> None:
    assert wanted(Twist.planar(asked), SAFE) == pytest.approx((given, given))


@pytest.mark.parametrize("turn", [2.5, 3.5, 4.5, 5.5])
def test_it_turns_no_faster_than_1_9(turn: float) -> None:
    assert body(wanted(Twist.planar(0.0, -turn), SAFE)) == pytest.approx((0.0, -MAX_TURN))


def test_a_twist_that_is_too_fast_keeps_its_radius() -> None:
    speed, turn = body(wanted(Twist.planar(0.3, 0.5), SAFE))
    assert (speed, turn) == pytest.approx((0.2562, 0.4271), abs=1e-4)
    assert speed / turn == pytest.approx(0.6)


@pytest.mark.parametrize("bad", [nan, inf, -inf])
def test_what_is_no_number_asks_for_nothing(bad: float) -> None:
    assert wanted(Twist.planar(bad, 0.1), SAFE) == STILL
    assert wanted(Twist.planar(0.1, bad), SAFE) == STILL


@example(1.7e308, 1.7e308)
@given(numbers, numbers)
def test_whatever_is_asked_the_limits_hold(speed: float, turn: float) -> None:
    pair = wanted(Twist.planar(speed, turn), SAFE)
    assert all(isfinite(wheel) and abs(wheel) <= SAFE * (1 + 1e-12) for wheel in pair)
    assert abs(body(pair)[1]) <= MAX_TURN * (1 + 1e-12)


@given(st.floats(-5, 5), st.floats(0.01, 9), st.sampled_from([1, -1]))
def test_whatever_is_asked_the_radius_is_kept(radius: float, turn: float, side: int) -> None:
    speed, turning = body(wanted(Twist.planar(radius * turn, side * turn), SAFE))
    assert speed / turning == pytest.approx(side * radius, abs=1e-9)
    assert turning * side > 0


def test_both_wheels_speed_up_by_one_factor() -> None:
    wheels = Wheels()
    target = wanted(Twist.planar(0.24, 0.48), SAFE)
    for _ in range(60):
        wheels.turn(target, 0.9, 0.01)
        assert wheels.speed / wheels.yaw_rate == pytest.approx(0.5)
        assert max(wheels.speeds) <= 0.9 * 0.01 * 60
    assert wheels.speeds == target


def test_it_takes_a_third_of_a_second_to_full_speed_and_as_long_to_rest() -> None:
    wheels = Wheels()
    for steps, target in ((34, (0.306, 0.306)), (34, STILL)):
        for _ in range(steps - 1):
            wheels.turn(target, 0.9, 0.01)
        assert wheels.speeds != target
        wheels.turn(target, 0.9, 0.01)
        assert wheels.speeds == target


def test_a_turn_of_a_wheel_is_508_8_ticks() -> None:
    wheels = Wheels()
    wheels.turn((0.2, -0.2), 1000.0, 0.01)
    assert wheels.turning == pytest.approx((5.594, -5.594), abs=1e-3)
    for _ in range(100):
        wheels.roll(0.01)
    assert wheels.ticks == (453, -453)  # 0.2 m of 0.2246 m


def test_a_wheel_that_halts_counts_no_further() -> None:
    wheels = Wheels()
    wheels.turn((0.2, 0.2), 1000.0, 1.0)
    wheels.roll(1.0)
    wheels.halt()
    assert (wheels.speed, wheels.yaw_rate) == (0.0, 0.0)
    wheels.turn(STILL, 0.9, 1.0)
    wheels.roll(1.0)
    assert wheels.ticks == (453, 453)
