import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.control import curvature
from zteleop.control.limiter import Limits, TwistLimiter, WheelLimiter
from zteleop.control.mixer import Ackermann, Differential
from zteleop.control.settings import DONKEYCAR
from zteleop.messages import Twist

CAR, TANK = Ackermann(), Differential()
speeds = st.floats(-10, 10)


def settle(limiter: TwistLimiter, wanted: Twist, start: float = 0.0, seconds: float = 5.0) -> Twist:
    limiter.limit(None, start)
    result = None
    for tick in range(1, int(seconds * 50)):
        result = limiter.limit(wanted, start + tick / 50)
    assert result
    return result


def test_none_is_rest_at_once() -> None:
    limiter = TwistLimiter(Limits(), CAR)
    assert settle(limiter, Twist.planar(1.0)).linear.x == pytest.approx(1.0)
    assert limiter.limit(None, 6.0) is None
    assert limiter.limit(Twist.planar(1.0), 6.02).linear.x == pytest.approx(0.06)


def test_acceleration_is_bounded() -> None:
    limiter = TwistLimiter(Limits(acceleration=2.0), CAR)
    limiter.limit(None, 0.0)
    assert limiter.limit(Twist.planar(1.0), 0.1).linear.x == pytest.approx(0.2)
    assert limiter.limit(Twist.planar(-1.0), 0.2).linear.x == pytest.approx(0.0)


@given(speeds, speeds)
def test_a_car_stays_on_its_curve_at_every_moment(speed: float, turn: float) -> None:
    limiter = TwistLimiter(Limits(speed=1.0, turn=2.0), CAR)
    limiter.limit(None, 0.0)
    wanted = curvature.of(speed, turn)
    for tick in range(1, 100):
        reached = limiter.limit(Twist.planar(speed, turn), tick / 50)
        assert curvature.of(reached.linear.x, reached.angular.z) == pytest.approx(wanted, rel=1e-6)
        assert abs(reached.linear.x) <= 1.0 + 1e-9


@given(speeds, speeds)
def test_a_tank_settles_on_its_curve_within_its_bounds(speed: float, turn: float) -> None:
    reached = settle(TwistLimiter(Limits(speed=1.0, turn=2.0), TANK), Twist.planar(speed, turn), seconds=10)
    assert abs(reached.linear.x) <= 1.0 + 1e-9
    assert abs(reached.angular.z) <= 2.0 + 1e-9
    assert reached.linear.x * turn == pytest.approx(reached.angular.z * speed, abs=1e-6)


def test_a_source_may_be_slower_than_the_vehicle() -> None:
    limiter = TwistLimiter(Limits(), CAR)
    limiter.limit(None, 0.0)
    assert limiter.limit(Twist.planar(2.0), 10.0, max_speed=0.4).linear.x == pytest.approx(0.4)


def test_a_bound_next_to_nothing_is_a_bound_as_well() -> None:
    limiter = TwistLimiter(Limits(), CAR)
    limiter.limit(None, 0.0)
    assert limiter.limit(Twist.planar(2.0, 1.0), 10.0, max_speed=1e-9).linear.x <= 1e-9
    wheels = WheelLimiter(Limits(), CAR, DONKEYCAR).cap({"throttle": 1.0, "steering": 1.0}, 1e-9)
    assert wheels == {"throttle": pytest.approx(1e-9 / 3), "steering": 1.0}


def test_a_standing_car_turns_its_wheels() -> None:
    limiter = TwistLimiter(Limits(), CAR)
    limiter.limit(None, 0.0)
    twist = limiter.limit(Twist.planar(0.0, curvature.turn(0.0, 1.2)), 0.02)
    assert twist.linear.x == 0.0
    assert CAR.mix(twist)["steering"] == pytest.approx(0.7282, abs=1e-3)


def test_pulse_duty_obeys_the_throttle_for_its_share_of_the_time() -> None:
    limiter = WheelLimiter(Limits(pulse_duty=0.9, pulse_duty_period=0.5), CAR, DONKEYCAR)
    limiter.limit({"throttle": 0.5, "steering": 0.5}, 0.0)
    obeyed = [limiter.limit({"throttle": 0.5, "steering": 0.5}, 10 + tick / 1000) for tick in range(1000)]
    assert sum(wheels["throttle"] > 0 for wheels in obeyed) == pytest.approx(900, abs=5)
    assert all(wheels["steering"] == 0.5 for wheels in obeyed)


def test_named_pulses_are_slewed_like_an_acceleration() -> None:
    limiter = WheelLimiter(Limits(acceleration=3.0), Ackermann(max_speed=3.0), DONKEYCAR)
    limiter.limit(None, 0.0)
    assert limiter.limit({"throttle": 1.0, "steering": 1.0}, 0.1) == {
        "throttle": pytest.approx(0.1),
        "steering": 1.0,
    }


def test_named_pulses_obey_the_speed_cap() -> None:
    limiter = WheelLimiter(Limits(speed=1.5), Ackermann(max_speed=3.0), DONKEYCAR)
    assert limiter.cap({"throttle": 1.0, "steering": -2.0}, None) == {"throttle": 0.5, "steering": -1.0}
    assert limiter.cap({"throttle": -1.0, "steering": 0.0}, 0.3)["throttle"] == pytest.approx(-0.1)


def test_named_pulses_obey_the_yaw_rate_on_their_curve() -> None:
    limiter = WheelLimiter(Limits(turn=0.1), CAR, DONKEYCAR)
    for steering, throttle in ((1.0, 1.0), (-0.3, -0.7), (1.0, 0.01), (0.0, 1.0), (1.0, 0.0)):
        made = limiter.cap({"throttle": throttle, "steering": steering}, None)
        assert made["steering"] == steering
        if throttle:
            assert abs(CAR.unmix(made).angular.z) <= 0.1 + 1e-9
            assert 0 < made["throttle"] / throttle <= 1.0


def test_limits_that_change_while_it_drives_hold_from_the_next_step() -> None:
    limiter = TwistLimiter(Limits(), CAR)
    assert settle(limiter, Twist.planar(2.0)).linear.x == pytest.approx(2.0)
    limiter.limits = Limits(speed=0.5, acceleration=2.0)
    assert limiter.limit(Twist.planar(2.0), 5.08).linear.x == pytest.approx(1.8)  # it brakes as it may
    assert settle(limiter, Twist.planar(2.0), 6.0).linear.x == pytest.approx(0.5)
    limiter.limits = Limits(turn=0.2)
    assert settle(limiter, Twist.planar(0.1, 1.0), 12.0).angular.z == pytest.approx(0.2)


def test_ticks_obey_limits_that_change_too() -> None:
    limiter = WheelLimiter(Limits(), CAR, DONKEYCAR)
    wheels = {"throttle": 1.0, "steering": 0.0}
    assert limiter.cap(wheels, None)["throttle"] == 1.0
    limiter.limits = Limits(speed=CAR.max_speed / 2, acceleration=CAR.max_speed / 10)
    assert limiter.cap(wheels, None)["throttle"] == pytest.approx(0.5)
    limiter.limit(wheels, 1.0)
    assert limiter.limit(wheels, 2.0) == {"throttle": pytest.approx(0.1), "steering": 0.0}


def test_limits_in_numbers_say_what_the_vehicle_can() -> None:
    assert Limits(turn=1.0).in_numbers(CAR) == Limits(speed=CAR.max_speed, turn=1.0)
