import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.control.servo import Servo
from zteleop.control.settings import DONKEYCAR

SERVOS = [
    Servo(channel=0),
    Servo(channel=0, min_us=2000, max_us=1000),
    Servo(channel=0, min_us=1100, neutral_us=1400, max_us=2000),
]


@pytest.mark.parametrize("servo", SERVOS)
@given(fraction=st.floats(-1, 1))
def test_a_fraction_survives_the_way_to_a_pulse_and_back(servo: Servo, fraction: float) -> None:
    assert servo.fraction(servo.pulse_us(fraction)) == pytest.approx(fraction, abs=1e-9)


@pytest.mark.parametrize("servo", SERVOS)
@given(fraction=st.floats(allow_nan=False, allow_infinity=False))
def test_no_fraction_leaves_the_ends(servo: Servo, fraction: float) -> None:
    ends = sorted((servo.min_us, servo.max_us))
    assert ends[0] - 1e-9 <= servo.pulse_us(fraction) <= ends[1] + 1e-9


@pytest.mark.parametrize("neutral", [900.0, 1000.0, 2000.0, 2100.0])
def test_neutral_outside_the_ends_is_refused(neutral: float) -> None:
    with pytest.raises(ValueError, match="neutral_us must lie between"):
        Servo(channel=0, neutral_us=neutral)


def test_donkeycars_calibration_in_ticks_at_60_hz() -> None:
    steering = DONKEYCAR["steering"].to_channel("steering", 4.08)
    throttle = DONKEYCAR["throttle"].to_channel("throttle", 4.08)
    assert (steering.min_ticks, steering.neutral_ticks, steering.max_ticks) == (290, 375, 460)
    assert (throttle.min_ticks, throttle.neutral_ticks, throttle.max_ticks) == (220, 370, 500)


@pytest.mark.parametrize(("dead_zone_us", "ticks"), [(20.4, 5), (20.0, 4), (134.64, 33), (0.0, 0)])
def test_a_dead_zone_of_whole_ticks_ends_on_the_last_of_them(dead_zone_us, ticks):
    servo = Servo(0, neutral_us=1248.48, dead_zone_us=dead_zone_us)  # 306 ticks, as floats go
    assert servo.to_channel("throttle", 4.08).dead_ticks == ticks


@pytest.mark.parametrize(("dead_zone_us", "ticks"), [(0.0, 0), (1.0, 0), (4.0, 1), (15.0, 4), (22.0, 5)])
def test_a_dead_zone_is_told_in_whole_ticks_that_turn_nothing(dead_zone_us, ticks):
    assert Servo(0, dead_zone_us=dead_zone_us).to_channel("throttle", 4.08).dead_ticks == ticks


def test_the_first_tick_beyond_a_dead_zone_turns_the_motor_wherever_neutral_lies_between_two():
    for tenth in range(410):
        servo = Servo(0, neutral_us=1500.0 + tenth / 10, dead_zone_us=30.0 + tenth / 20)
        channel = servo.to_channel("throttle", 4.08)
        for sign in (1, -1):
            first = 4.08 * (channel.neutral_ticks + sign * (channel.dead_ticks + 1))
            assert abs(first - servo.neutral_us) > servo.dead_zone_us
