from math import nan

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.control.servo import Servo
from zteleop.sim.esc import Esc, EscSettings, Reverse, fraction

ESC = EscSettings()


@pytest.mark.parametrize("pulse_us", [None, 499.0, 2501.0, 0.0, nan])
def test_what_is_no_servo_pulse_asks_for_nothing(pulse_us: float | None) -> None:
    assert fraction(Servo(0), pulse_us) is None
    assert ESC.throttle(Servo(0), pulse_us) == 0.0


def test_a_pulse_beyond_the_calibration_is_the_end() -> None:
    assert [fraction(Servo(0), width) for width in (500, 1000, 1500, 2000, 2500)] == [-1, -1, 0, 1, 1]


def test_a_reversed_servo_is_reversed() -> None:
    reverse = Servo(0, min_us=2000, max_us=1000)
    assert ESC.throttle(reverse, 1250) == pytest.approx(0.5)


@pytest.mark.parametrize(("pulse_us", "expected"), [(1515, 0.0), (1485, 0.0), (1520, 0.04), (1480, -0.04)])
def test_near_neutral_the_motor_rests(pulse_us: float | None, expected: float) -> None:
    assert ESC.throttle(Servo(0), pulse_us) == pytest.approx(expected)


def run(speed: float, wanted: float, seconds: float, settings: EscSettings = ESC) -> float:
    for _ in range(round(seconds / 0.01)):
        speed = settings.spin(speed, wanted, 0.01)
    return speed


@pytest.mark.parametrize("wanted", [0.5, -0.5])
def test_the_motor_lags_and_then_arrives(wanted: float) -> None:
    assert run(0.0, wanted, ESC.motor_lag) == pytest.approx(wanted * 0.63, rel=0.05)
    assert run(0.0, wanted, 3.0) == pytest.approx(wanted)


@pytest.mark.parametrize("speed", [2.0, -2.0])
def test_a_wheel_nobody_drives_comes_to_a_stand(speed: float) -> None:
    assert run(speed, 0.0, 2.0) == 0.0


def test_rolling_resistance_shortens_the_way() -> None:
    assert run(1.0, 0.0, 0.3) < run(1.0, 0.0, 0.3, EscSettings(rolling_resistance=0))


@given(st.floats(-10, 10), st.floats(-10, 10), st.floats(1e-6, 0.01))
def test_the_tyres_hold_no_more_than_their_grip(speed: float, wanted: float, dt: float) -> None:
    after = ESC.spin(speed, wanted, dt)
    assert abs(after - speed) <= ESC.grip * dt * (1 + 1e-9) + 1e-12


@given(st.floats(-10, 10), st.floats(1e-6, 1.0))
def test_braking_never_ends_in_reverse(speed: float, dt: float) -> None:
    assert ESC.spin(speed, 0.0, dt) * speed >= 0


FORWARD, NEUTRAL, BACK = 1700.0, 1500.0, 1300.0


def after(reverse: Reverse, *pulses: float) -> float:
    """Return the speed after half a second of each pulse in turn."""
    esc, speed = Esc(EscSettings(reverse=reverse)), 0.0
    for pulse in pulses:
        for _ in range(50):
            speed = esc.drive(speed, Servo(0), pulse, 3.0, 0.01)
    return speed


def test_a_direct_one_reverses_at_once() -> None:
    assert after("direct", FORWARD, BACK) < -0.5


def test_one_that_is_tapped_twice_brakes_first_however_long_and_then_reverses() -> None:
    assert after("double_tap", FORWARD, BACK, BACK, BACK) == 0.0
    assert after("double_tap", FORWARD, BACK, NEUTRAL) == 0.0
    assert after("double_tap", FORWARD, BACK, NEUTRAL, BACK) < -0.5


def test_it_brakes_at_the_first_reverse_after_it_was_switched_on() -> None:
    assert after("double_tap", BACK) == 0.0
    assert after("double_tap", NEUTRAL, BACK) == 0.0
    assert after("double_tap", FORWARD, NEUTRAL, BACK) == 0.0
    assert after("double_tap", BACK, NEUTRAL, BACK) < -0.5


def test_once_it_was_forward_it_must_be_tapped_again() -> None:
    assert after("double_tap", BACK, NEUTRAL, BACK, NEUTRAL, FORWARD, BACK) == 0.0


def test_it_stays_in_reverse_through_neutral() -> None:
    assert after("double_tap", BACK, NEUTRAL, BACK, NEUTRAL, BACK) < -0.5


def test_one_without_reverse_brakes_for_ever() -> None:
    assert after("none", FORWARD, BACK, NEUTRAL, BACK) == 0.0


def test_a_brake_stops_sooner_than_neutral_does() -> None:
    def seconds(pulse: float) -> float:
        esc, speed, steps = Esc(EscSettings(reverse="double_tap")), 2.0, 0
        while speed > 0.01:
            speed, steps = esc.drive(speed, Servo(0), pulse, 3.0, 0.01), steps + 1
        return steps * 0.01

    assert seconds(BACK) < seconds(NEUTRAL)


def test_its_deadband_is_what_the_config_says_of_it_and_never_less_than_any_has() -> None:
    wide, narrow = Servo(0, dead_zone_us=60.0), Servo(0, dead_zone_us=2.0)
    assert ESC.throttle(wide, 1559.0) == 0.0
    assert ESC.throttle(wide, 1561.0) > 0
    assert ESC.throttle(narrow, 1510.0) == 0.0
    assert EscSettings(esc_deadband_us=5.0).throttle(wide, 1510.0) > 0, "another than the config believes"
