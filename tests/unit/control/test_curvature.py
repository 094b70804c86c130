from math import isfinite

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from zteleop.control import curvature
from zteleop.control.curvature import CRAWL, STANDSTILL
from zteleop.control.limiter import Limits, TwistLimiter
from zteleop.control.mixer import Ackermann
from zteleop.messages import Twist

DENORMAL = 5e-324
CAR = Ackermann()


@pytest.mark.parametrize("speed", [0.0, -0.0, DENORMAL, -DENORMAL, CRAWL * 0.999, -CRAWL * 0.999])
def test_a_car_that_hardly_moves_stands(speed: float) -> None:
    assert not curvature.rolls(speed)
    assert curvature.of(speed, 0.2) == pytest.approx(0.2 / STANDSTILL)
    assert curvature.turn(speed, 2.0) == pytest.approx(2.0 * STANDSTILL)


@pytest.mark.parametrize("speed", [CRAWL, -CRAWL, 0.5])
def test_a_car_that_rolls_bends_as_it_turns(speed: float) -> None:
    assert curvature.rolls(speed)
    assert curvature.of(speed, 0.2) == pytest.approx(0.2 / speed)


@given(st.floats(-10, 10), st.floats(-10, 10))
@example(DENORMAL, 1.0)
@example(-DENORMAL, 1.0)
@example(1e-310, -10.0)
def test_no_speed_makes_a_curvature_of_anything(speed: float, turn: float) -> None:
    bend = curvature.of(speed, turn)
    assert isfinite(bend)
    assert curvature.turn(speed, bend) == pytest.approx(turn)


@pytest.mark.parametrize("speed", [DENORMAL, -DENORMAL, CRAWL / 2])
def test_the_wheels_of_a_car_that_hardly_moves_point_as_if_it_stood(speed: float) -> None:
    limiter = TwistLimiter(Limits(), CAR)
    limiter.limit(None, 0.0)
    standing = CAR.mix(Twist.planar(0.0, 0.05))["steering"]
    assert CAR.mix(limiter.limit(Twist.planar(speed, 0.05), 1.0))["steering"] == pytest.approx(standing)
