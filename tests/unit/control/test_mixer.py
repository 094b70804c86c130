import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.control.mixer import Ackermann, Differential
from zteleop.messages import Twist

CAR = Ackermann(wheelbase=0.25, max_steering_angle=0.4, max_speed=3.0)
TANK = Differential(track=0.2, max_speed=1.0)


@given(st.floats(-3, 3).filter(lambda v: abs(v) > 1e-3), st.floats(-1.6, 1.6))
def test_a_car_undoes_what_it_mixes(speed: float, bend: float) -> None:
    back = CAR.unmix(CAR.mix(Twist.planar(speed, speed * bend)))
    assert back.linear.x == pytest.approx(speed)
    assert back.angular.z == pytest.approx(speed * bend, abs=1e-9)


@given(st.floats(-1, 1), st.floats(-1, 1))
def test_a_tank_undoes_what_it_mixes_within_its_speed(speed: float, turn: float) -> None:
    wheels = TANK.mix(Twist.planar(speed, turn))
    scale = max(1.0, abs(speed) + abs(turn) * 0.1)
    back = TANK.unmix(wheels)
    assert back.linear.x == pytest.approx(speed / scale, abs=1e-9)
    assert back.angular.z == pytest.approx(turn / scale, abs=1e-9)


@given(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6))
def test_wheels_never_exceed_full_range(speed: float, turn: float) -> None:
    for mixer in (CAR, TANK):
        assert all(abs(fraction) <= 1 for fraction in mixer.mix(Twist.planar(speed, turn)).values())


def test_reversing_a_car_keeps_its_wheels_where_the_curve_is() -> None:
    forward, back = CAR.mix(Twist.planar(1.0, 1.0)), CAR.mix(Twist.planar(-1.0, -1.0))
    assert forward["steering"] == back["steering"] > 0
    assert forward["throttle"] == -back["throttle"]


def test_left_is_positive() -> None:
    wheels = TANK.mix(Twist.planar(0.0, 1.0))
    assert wheels["left"] < 0 < wheels["right"]
    assert TANK.max_turn == pytest.approx(10.0)
    assert CAR.max_turn == pytest.approx(3.0 * math.tan(0.4) / 0.25)
