"""Seven pulses that somebody has seen make two servos."""

from random import Random

import pytest
from msgspec.structs import replace

from zteleop.control.measuring import MOTOR_FIRST, STEPS, TRIM, WIDEST, Measuring
from zteleop.control.settings import DONKEYCAR
from zteleop.sim.unknown import unknown

TICK = 4.08
FOUND = {
    "forward starts": 1560.0,
    "reverse starts": 1480.0,
    "straight": 1540.0,
    "full left": 1900.0,
    "full right": 1200.0,
    "full forward": 1990.0,
    "full reverse": 1100.0,
}


def begun(**found: float) -> Measuring:
    """Return one that was told what it asked for, or else left it as it was."""
    measuring = Measuring(DONKEYCAR, TICK)
    for step in STEPS:
        if measuring.is_over:
            measuring.go_on()
        if (pulse := found.get(step.find.replace(" ", "_"))) is None:
            measuring.skip()
        else:
            assert measuring.take(pulse) == ""
    return measuring


def at(find: str) -> Measuring:
    """Return one that asks for this, after all before it were found."""
    measuring = Measuring(DONKEYCAR, TICK)
    for step in STEPS:
        if measuring.is_over:
            measuring.go_on()
        if step.find == find:
            return measuring
        assert measuring.take(FOUND[step.find]) == ""
    raise AssertionError(find)


def named(found: dict[str, float]) -> dict[str, float]:
    return {find.replace(" ", "_"): pulse for find, pulse in found.items()}


def test_neutral_is_midway_between_the_two_starts_and_the_dead_zone_a_tick_less_than_half_of_it() -> None:
    throttle = begun(**named(FOUND)).servos()["throttle"]
    assert throttle.neutral_us == 1520
    assert throttle.dead_zone_us == pytest.approx(40 - TICK)
    assert (throttle.min_us, throttle.max_us, throttle.channel) == (1100, 1990, 0)


def test_steering_has_its_ends_where_they_were_seen() -> None:
    steering = begun(**named(FOUND)).servos()["steering"]
    assert (steering.min_us, steering.neutral_us, steering.max_us) == (1200, 1540, 1900)


def test_a_servo_that_is_built_in_upside_down_has_its_left_below_its_right() -> None:
    steering = begun(full_left=1200.0, full_right=1900.0).servos()["steering"]
    assert (steering.min_us, steering.max_us) == (1900, 1200)
    assert steering.pulse_us(1.0) == 1200


def test_what_is_left_out_stays_as_it_was() -> None:
    assert begun().servos() == DONKEYCAR
    assert begun(straight=1540.0).servos()["throttle"] == DONKEYCAR["throttle"]


def test_one_start_alone_is_no_neutral() -> None:
    assert begun(forward_starts=1560.0).servos()["throttle"] == DONKEYCAR["throttle"]


@pytest.mark.parametrize(
    ("find", "pulse", "words"),
    [
        ("reverse starts", 1561.0, "other side of neutral"),
        ("full left", 1545.0, "go on until"),
        ("full right", 1800.0, "go to the other side"),
        ("full right", 1530.0, "go to the other side"),
        ("full forward", 1565.0, "hardly faster"),
        ("full forward", 1300.0, "turn backward"),
        ("full reverse", 1500.0, "hardly faster"),
        ("full reverse", 1800.0, "turn forward"),
    ],
)
def test_what_cannot_be_is_not_taken_and_the_step_is_asked_again(find: str, pulse: float, words: str) -> None:
    measuring = at(find)
    assert words in measuring.take(pulse)
    assert measuring.step.find == find


def test_after_the_motor_is_known_the_robot_rests_at_its_own_neutral() -> None:
    measuring = Measuring(DONKEYCAR, TICK)
    assert measuring.wide()["throttle"].neutral_us == DONKEYCAR["throttle"].neutral_us
    measuring.take(1560.0)
    measuring.take(1480.0)
    assert measuring.is_over
    assert measuring.number == MOTOR_FIRST
    wide = measuring.wide()
    assert (wide["throttle"].min_us, wide["throttle"].neutral_us, wide["throttle"].max_us) == (
        WIDEST[0],
        1520,
        WIDEST[1],
    )


def test_nothing_is_taken_between_the_two_parts() -> None:
    measuring = at("reverse starts")
    measuring.take(1480.0)
    measuring.take(1481.0)
    assert "straight" not in measuring.found


def test_back_asks_once_more_but_never_what_neutral_was_made_of() -> None:
    measuring = at("full left")
    assert measuring.back() == ""
    assert measuring.step.find == "straight"
    assert "neutral that was found is in use" in measuring.back()
    assert measuring.step.find == "straight"
    assert Measuring(DONKEYCAR, TICK).back() == "this is the first"


def test_what_is_skipped_after_it_was_found_is_forgotten() -> None:
    measuring = at("full left")
    measuring.back()
    measuring.skip()
    assert "straight" not in measuring.found


@pytest.mark.parametrize("seed", range(20))
def test_whoever_sees_the_wheels_of_an_unknown_car_finds_it_within_two_ticks(seed: int) -> None:
    """The eye sees a tick as it begins: a motor that turns, a wheel that turns no further."""
    really, settings = unknown(DONKEYCAR, seed)
    throttle, steering = really["throttle"], really["steering"]
    beyond = settings.esc_deadband_us + Random(seed).uniform(0.01, TICK)
    found = begun(
        forward_starts=throttle.neutral_us + beyond,
        reverse_starts=throttle.neutral_us - beyond,
        straight=steering.neutral_us,
        full_left=steering.max_us,
        full_right=steering.min_us,
        full_forward=throttle.max_us,
        full_reverse=throttle.min_us,
    ).servos()
    for name, servo in really.items():
        for field in ("min_us", "neutral_us", "max_us"):
            assert abs(getattr(found[name], field) - getattr(servo, field)) <= 2 * TICK
    assert abs(found["throttle"].dead_zone_us - settings.esc_deadband_us) <= TICK


def gone_through(measuring: Measuring, *pulses: float) -> Measuring:
    for pulse in pulses:
        measuring.see(pulse)
    return measuring


NEUTRAL = DONKEYCAR["throttle"].neutral_us
BACK = FOUND["reverse starts"]


@pytest.mark.parametrize(
    ("pulses", "reverse"),
    [
        ((NEUTRAL, 1495, BACK), "direct"),
        ((NEUTRAL, BACK - 30, NEUTRAL, 1495, BACK), "double_tap"),
        ((NEUTRAL, BACK, NEUTRAL, BACK), "double_tap"),
        ((NEUTRAL, 1560, NEUTRAL, BACK), "direct"),
        ((NEUTRAL, 1495, NEUTRAL, BACK), "direct"),
    ],
    ids=["at once", "the second time", "as far", "forward before", "less far before"],
)
def test_an_esc_brakes_first_where_the_wheels_turned_back_only_the_second_time(
    pulses: tuple[float, ...], reverse: str
) -> None:
    measuring = gone_through(at("reverse starts"), *pulses)
    assert measuring.take(BACK) == ""
    assert measuring.servos()["throttle"].reverse == reverse


def test_what_was_gone_through_before_the_step_or_before_going_back_to_it_does_not_count() -> None:
    measuring = gone_through(at("forward starts"), BACK, NEUTRAL)
    measuring.take(FOUND["forward starts"])
    gone_through(measuring, BACK, NEUTRAL)
    measuring.back()
    measuring.take(FOUND["forward starts"])
    gone_through(measuring, BACK).take(BACK)
    assert measuring.servos()["throttle"].reverse == "direct"


def test_an_esc_of_which_nothing_was_found_is_what_it_was() -> None:
    throttle = replace(DONKEYCAR["throttle"], reverse="none")
    measuring = Measuring(DONKEYCAR | {"throttle": throttle}, TICK)
    measuring.skip()
    measuring.skip()
    assert measuring.servos()["throttle"].reverse == "none"


def test_a_trim_is_one_step_with_the_servos_as_they_are() -> None:
    measuring = Measuring(DONKEYCAR, TICK, TRIM)
    assert measuring.wide() == DONKEYCAR
    assert measuring.take(1540.0) == ""
    assert measuring.is_over
    assert measuring.is_done
    steering = measuring.servos()["steering"]
    assert steering == replace(DONKEYCAR["steering"], neutral_us=1540.0)
    assert measuring.servos()["throttle"] == DONKEYCAR["throttle"]
