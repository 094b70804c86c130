import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec import ValidationError, convert

from zteleop.control.stick import Stick, to_pwm
from zteleop.errors import ConfigError
from zteleop.inputs.levers import Lever, Levers, Steps
from zteleop.messages import Channel, Vehicle


def fitted(vehicle: Vehicle, steps: Steps | None = None) -> Levers:
    levers = Levers(steps)
    levers.fit(vehicle)
    return levers


def test_a_press_moves_one_step_and_stays(car):
    levers = fitted(car)
    levers.press("steering", -1)
    levers.press("throttle", 1)
    levers.press("throttle", 1)
    pwm = to_pwm(levers.stick(), car)
    assert (pwm.steering_ticks, pwm.throttle_ticks) == (360, 372)


def test_a_step_never_overshoots_and_an_end_is_an_end(car):
    lever = Lever(car.channels[0], 15)
    seen = []
    for _ in range(8):
        lever.press(1)
        seen.append(lever.ticks)
    assert seen == [390, 405, 420, 435, 450, 460, 460, 460]


def test_as_many_steps_back_lead_to_neutral_exactly(car):
    lever = Lever(car.channels[0], 15)
    for sign in [1] * 6 + [-1] * 6:
        lever.press(sign)
    assert lever.ticks == 375


def test_left_goes_to_the_left_end_whichever_number_is_larger():
    lever = Lever(Channel("steering", 1, 2000.0, 1500.0, 1000.0, 460, 375, 290, 0), 15)
    lever.press(1)
    assert (lever.ticks, lever.fraction > 0) == (360, True)
    lever.press(-1)
    lever.press(-1)
    assert (lever.ticks, lever.fraction < 0) == (390, True)


def test_an_axis_without_a_side_does_not_move_there():
    lever = Lever(Channel("throttle", 0, 1500.0, 1500.0, 2000.0, 370, 370, 400, 0), 1)
    lever.press(-1)
    assert (lever.ticks, lever.fraction) == (370, 0.0)


def test_nobody_holds_levers_at_rest(car):
    levers = fitted(car)
    assert levers.stick() == Stick()
    levers.press("steering", 1)
    assert levers.stick().deadman
    levers.press("steering", -1)
    assert not levers.stick().deadman


def test_neutral_can_be_for_one_axis(car):
    levers = fitted(car)
    levers.press("steering", 1)
    levers.press("throttle", 1)
    levers.neutral("throttle")
    assert levers.stick().forward == 0
    assert levers.stick().turn > 0
    levers.neutral()
    assert levers.stick() == Stick()


def test_another_calibration_is_neutral_and_the_same_one_changes_nothing(car):
    levers = fitted(car)
    levers.press("steering", 1)
    assert not levers.fit(car)
    assert levers.stick().deadman
    car.channels[0] = Channel("steering", 1, 1000.0, 1500.0, 2000.0, 300, 375, 460, 0)
    assert levers.fit(car)
    assert not levers.stick().deadman


def test_without_a_calibration_nothing_moves():
    levers = Levers()
    levers.press("throttle", 1)
    levers.neutral("throttle")
    assert levers.stick() == Stick()


def test_a_vehicle_without_steering_is_refused_in_words(tank):
    with pytest.raises(ConfigError, match="found left, right; drive with --drive hold"):
        Levers().fit(tank)


@pytest.mark.parametrize("bad", [{"steering_step_ticks": 0}, {"step": 1}])
def test_settings_are_checked(bad):
    with pytest.raises(ValidationError):
        convert(bad, Steps)


@given(
    st.lists(st.tuples(st.sampled_from(("steering", "throttle")), st.sampled_from((-1, 1))), max_size=80),
    st.tuples(*[st.integers(0, 4095)] * 3).map(sorted),
    st.booleans(),
    st.integers(1, 400),
    st.integers(0, 400),
)
def test_whatever_is_pressed_ticks_stay_within_and_come_back_exactly(presses, ends, swapped, step, dead):
    low, neutral, high = reversed(ends) if swapped else ends
    channels = [
        Channel(name, i, 1.0, 2.0, 3.0, low, neutral, high, dead)
        for i, name in enumerate(("steering", "throttle"))
    ]
    vehicle = Vehicle("ackermann", channels, 1.0, 1.0, 0.2, 0.4, 5.0, 4.08, True, 9.0)
    levers = fitted(vehicle, Steps(step, step))
    for axis, sign in presses:
        levers.press(axis, sign)
        stick = levers.stick()
        assert -1 <= stick.turn <= 1
        assert -1 <= stick.forward <= 1
        if pwm := to_pwm(stick, vehicle):
            assert pwm.steering_ticks == levers._levers["steering"].ticks
            assert min(ends) <= pwm.steering_ticks <= max(ends)
            assert pwm.throttle_ticks == levers._levers["throttle"].ticks


@given(
    st.tuples(*[st.integers(0, 4095)] * 3).map(sorted),
    st.integers(1, 50),
    st.integers(-90, 90),
    st.integers(0, 90),
)
def test_counting_steps_undoes_pressing_them(ends, step, presses, dead):
    lever = Lever(Channel("steering", 0, 1.0, 2.0, 3.0, *ends, dead), step)
    for _ in range(abs(presses)):
        lever.press(1 if presses > 0 else -1)
    assert lever.count(lever.ticks) == lever.steps


@pytest.mark.parametrize(
    ("ticks", "count"), [(376, 1), (450, 5), (451, 5), (459, 5), (460, 6), (291, -5), (290, -6)]
)
def test_only_the_end_counts_as_all_steps(ticks, count):
    assert Lever(Channel("steering", 0, 1.0, 2.0, 3.0, 290, 375, 460, 0), 15).count(ticks) == count


def test_the_first_step_goes_beyond_the_dead_zone_and_the_next_is_a_step_more():
    lever = Lever(Channel("throttle", 0, 1.0, 2.0, 3.0, 355, 370, 400, 3), 1)
    seen = []
    for sign in (1, 1, -1, -1, -1, -1):
        lever.press(sign)
        seen.append(lever.ticks)
    assert seen == [374, 375, 374, 370, 366, 365]
    assert (lever.most(1), lever.most(-1)) == (27, 12)
