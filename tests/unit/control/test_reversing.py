"""What an ESC is told that brakes first, and what one of that kind makes of it."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import replace

from zteleop.control.drive import Drive
from zteleop.control.proof import Prover
from zteleop.control.reversing import BRAKES, RESTS, Reversing
from zteleop.control.servo import Reverse, Servo
from zteleop.control.settings import DONKEYCAR, DriveSettings
from zteleop.control.vehicles import VEHICLES
from zteleop.messages import Pwm, Twist
from zteleop.sim import make_vehicle

STEP = 0.02
THROTTLE = DONKEYCAR["throttle"]


def told(reverse: Reverse, *asked: tuple[float, float]) -> list[float]:
    """Return what an ESC is told at each step, for fractions that are asked for so many s each."""
    reversing, now, found = Reversing({"throttle": replace(THROTTLE, reverse=reverse)}), 0.0, []
    for fraction, seconds in asked:
        for _ in range(round(seconds / STEP)):
            wheels = reversing.ask({"throttle": fraction})
            reversing.note(wheels, now)
            found.append(wheels["throttle"])
            now += STEP
    return found


def phases(values: list[float]) -> list[float]:
    """Return each value once that stands beside itself."""
    return [value for value, before in zip(values, [None, *values], strict=False) if value != before]


def test_one_that_reverses_is_told_what_is_asked_for() -> None:
    assert phases(told("direct", (0.5, 1.0), (-0.3, 1.0))) == [0.5, -0.3]


def test_one_that_brakes_first_is_told_to_brake_then_neutral_and_then_to_reverse() -> None:
    found = told("double_tap", (0.5, 1.0), (-0.3, 1.0))
    assert phases(found) == [0.5, -0.3, 0.0, -0.3]
    back = found[50:]
    brakes, rests = back.index(0.0) * STEP, back.count(0.0) * STEP
    assert brakes == pytest.approx(BRAKES + STEP, abs=STEP / 2)
    assert rests == pytest.approx(RESTS + STEP, abs=STEP / 2)


def test_it_goes_on_in_reverse_until_it_was_forward_again() -> None:
    asked = ((-0.3, 0.5), (0.0, 1.0), (-0.4, 0.5), (0.2, 0.1), (-0.5, 0.5))
    assert phases(told("double_tap", *asked)) == [-0.3, 0.0, -0.3, 0.0, -0.4, 0.2, -0.5, 0.0, -0.5]


def test_a_brake_that_was_too_short_for_it_to_notice_is_none() -> None:
    found = told("double_tap", (-0.3, BRAKES / 2), (0.0, 1.0), (-0.4, 0.5))
    assert phases(found) == [-0.3, 0.0, -0.4, 0.0, -0.4]


def test_one_that_only_brakes_is_told_neutral_where_somebody_asks_for_a_way_backward() -> None:
    assert phases(told("none", (0.5, 0.1), (-0.3, 1.0))) == [0.5, 0.0]


def test_what_is_within_the_dead_zone_is_neutral() -> None:
    hardly = -0.9 * THROTTLE.dead_zone_us / (THROTTLE.neutral_us - THROTTLE.min_us)
    found = told("double_tap", (-0.3, 0.5), (0.1, 0.1), (-0.3, 0.14), (hardly, 0.5), (-0.3, 0.1))
    assert phases(found)[-3:] == [0.0, hardly, -0.3]


@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(0.02, 0.3)), max_size=10))
def test_it_is_never_told_anything_but_what_is_asked_for_or_neutral(asked: list[tuple[float, float]]) -> None:
    wanted = [fraction for fraction, seconds in asked for _ in range(round(seconds / STEP))]
    assert all(at in (0.0, ask) for at, ask in zip(told("double_tap", *asked), wanted, strict=True))


class Car:
    """A car whose ESC is of some kind, and somebody who drives it."""

    def __init__(self, reverse: Reverse, settings: DriveSettings | None = None) -> None:
        servos = DONKEYCAR | {"throttle": replace(THROTTLE, reverse=reverse)}
        settings = settings or DriveSettings(servos=servos)
        self.drive = Drive(settings, 4.08, 1, 0.0)
        self.body = make_vehicle(settings.mixer, settings.servos)
        self.prover, self.now = Prover(7), 0.0

    def obey(self, seconds: float, command: Twist | Pwm | None, channel: int = 0) -> list[float]:
        """Command something for so many s; return the pulses of a channel."""
        found = []
        for _ in range(round(seconds / STEP)):
            self.now += STEP
            beat = self.drive.admission.beat(self.now)
            self.prover.act(beat)
            if command:
                proof = self.prover.prove(beat, True, self.now, 0.0)
                assert self.drive.receive("keyboard", command, proof, self.now) is None
            pulse_us = self.drive.step(self.now).pulse_us
            self.body.move(pulse_us, STEP)
            found.append(pulse_us[channel])
        return found


@pytest.mark.parametrize(("reverse", "goes"), [("direct", True), ("double_tap", True), ("none", False)])
def test_whoever_asks_for_a_speed_backward_gets_it_where_there_is_one(reverse: Reverse, goes: bool) -> None:
    car = Car(reverse)
    car.obey(1.0, Twist.planar(1.0))
    assert car.body.speed == pytest.approx(1.0, abs=0.1)
    car.obey(2.0, Twist.planar(-0.6))
    assert (car.body.speed < -0.4) is goes


def test_after_the_second_tap_it_speeds_up_as_slowly_as_any() -> None:
    car = Car("double_tap")
    pulses = car.obey(2.0, Twist.planar(-2.0))
    most = 3.0 / 3.0 * STEP * (THROTTLE.neutral_us - THROTTLE.min_us)
    again = pulses[pulses.index(THROTTLE.neutral_us, 3) :]
    assert min(after - before for before, after in pairwise(again)) >= -most - 0.1


def test_a_tank_speeds_up_as_slowly_as_any_too() -> None:
    built = VEHICLES["tank"]
    servos = {name: replace(servo, reverse="double_tap") for name, servo in built.servos.items()}
    car = Car("double_tap", DriveSettings(mixer=built.mixer, servos=servos))
    left = servos["left"]
    speeds = [left.fraction(pulse) * built.mixer.max_speed for pulse in car.obey(1.0, Twist.planar(-1.0), 0)]
    assert speeds[-1] < -0.5
    again = speeds[speeds.index(0.0, 3) :]
    most = car.drive.settings.limits.acceleration * STEP
    assert min(after - before for before, after in pairwise(again)) >= -most - 0.01


def test_ticks_are_told_as_they_are() -> None:
    car = Car("double_tap")
    car.obey(0.5, Pwm(375, 400))
    assert THROTTLE.neutral_us not in car.obey(1.0, Pwm(375, 340))[20:]
    assert car.body.speed == 0.0, "it brakes: whoever says ticks taps it himself"


def test_a_stop_is_neutral_at_once_and_what_comes_after_it_taps_anew() -> None:
    car = Car("double_tap")
    car.obey(0.5, Twist.planar(1.0))
    car.obey(0.06, Twist.planar(-1.0))
    assert car.obey(0.5, None)[-1] == THROTTLE.neutral_us


def test_reverse_is_for_what_drives() -> None:
    servos = DONKEYCAR | {"steering": Servo(channel=1, reverse="double_tap")}
    with pytest.raises(ValueError, match=r"reverse is for what drives, found it at servos\.steering"):
        DriveSettings(servos=servos)
