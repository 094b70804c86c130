"""What `zteleop calibrate` makes of keys: what is asked for turns, and what is put out is an answer."""

from typing import Any

import pytest

from zteleop.control.measuring import MOTOR_FIRST, STEPS, Measuring
from zteleop.control.report import to_vehicle
from zteleop.control.settings import DONKEYCAR, DriveSettings
from zteleop.control.stick import to_pwm
from zteleop.inputs import Wish
from zteleop.inputs.tuner import Tuner
from zteleop.messages import Pulse, Pwm
from zteleop.terminal.typed import Typed
from zteleop.testing.terminal import FakeTerminal

TICK = 4.08
UP, DOWN, RIGHT, LEFT = b"\x1b[A", b"\x1b[B", b"\x1b[C", b"\x1b[D"
FAR_UP, FAR_DOWN, ENTER = b"\x1b[5~", b"\x1b[6~", b"\r"
REST = (375, 370)


class Hand:
    """Types, sees to it that the robot obeys, and shows the tuner what the robot says."""

    def __init__(self) -> None:
        self.terminal = FakeTerminal()
        self.measuring = Measuring(DONKEYCAR, TICK)
        typed: Any = Typed(self.terminal)  # type: ignore[arg-type]
        self.tuner = Tuner(typed, self.measuring)
        self.now = 10.0
        self.vehicle = to_vehicle(DriveSettings(servos=self.measuring.wide()), TICK)
        self.tuner.fit(self.vehicle)
        self.type(b"")

    def type(self, keys: bytes, after: float = 1.0) -> None:
        self.now += after
        self.terminal.typed = keys
        self.tuner.read(self.now)
        self.show()

    def show(self, *, off: int = 0) -> None:
        asked = self.asked
        steering, throttle = (asked.steering_ticks, asked.throttle_ticks) if asked else REST
        pulses = [
            Pulse("throttle", 0, 0.0, (throttle + off) * TICK, throttle + off),
            Pulse("steering", 1, 0.0, steering * TICK, steering),
        ]
        self.tuner.see(pulses)

    @property
    def asked(self) -> Pwm | None:
        return to_pwm(self.tuner.stick(self.now), self.vehicle)

    @property
    def ticks(self) -> tuple[int, int]:
        return (self.asked.steering_ticks, self.asked.throttle_ticks) if self.asked else REST

    def go_to(self, number: int) -> None:
        """Leave what comes before a step as it was."""
        for _ in STEPS[:number]:
            if self.measuring.is_over:
                self.measuring.go_on()
            self.type(b"s")
        if self.measuring.is_over:
            self.measuring.go_on()
            self.tuner = Tuner(Typed(self.terminal), self.measuring)  # type: ignore[arg-type]
            self.tuner.fit(self.vehicle)
            self.type(b"")


@pytest.fixture
def hand() -> Hand:
    return Hand()


def test_a_press_is_a_tick_and_a_page_is_ten(hand: Hand) -> None:
    hand.type(UP + UP)
    assert hand.ticks == (375, 372)
    hand.type(FAR_UP)
    assert hand.ticks == (375, 382)
    hand.type(FAR_DOWN + DOWN)
    assert hand.ticks == (375, 371)


def test_the_servo_that_is_not_asked_for_does_not_turn(hand: Hand) -> None:
    hand.type(LEFT + RIGHT + RIGHT)
    assert hand.ticks == REST
    hand.go_to(2)
    hand.type(UP)
    assert hand.ticks == REST
    hand.type(FAR_UP)
    assert hand.ticks == (385, 370)


def test_an_answer_is_what_leaves_the_chip_and_then_it_rests(hand: Hand) -> None:
    hand.type(FAR_UP + UP)
    hand.type(ENTER)
    assert hand.measuring.found == {"forward starts": pytest.approx(381 * TICK)}
    assert hand.ticks == REST
    assert ("found", "forward starts 381") in hand.tuner.about


def test_what_the_chip_does_not_put_out_is_no_answer(hand: Hand) -> None:
    hand.type(FAR_UP)
    hand.show(off=-5)
    hand.type(ENTER, 0.1)
    assert hand.measuring.found == {}
    assert "asked for 380, and the chip puts out 375" in hand.tuner.in_vain
    hand.type(ENTER)
    assert "forward starts" in hand.measuring.found


def test_an_esc_is_seen_to_brake_first(hand: Hand) -> None:
    hand.type(FAR_UP)
    hand.type(ENTER)
    for keys in (FAR_DOWN, b" ", FAR_DOWN):
        hand.type(keys)
    hand.type(ENTER)
    assert hand.measuring.servos()["throttle"].reverse == "double_tap"


def test_a_robot_that_is_not_heard_answers_nothing(hand: Hand) -> None:
    hand.type(UP)
    hand.tuner.see(())
    hand.terminal.typed = ENTER
    hand.tuner.read(hand.now + 0.1)
    assert hand.measuring.found == {}
    assert "not heard" in hand.tuner.in_vain


def test_neutral_that_came_by_itself_is_no_answer(hand: Hand) -> None:
    hand.type(FAR_UP)
    hand.type(b"", after=6.0)
    assert hand.ticks == REST
    hand.type(ENTER)
    assert hand.measuring.found == {}
    assert "it is at neutral, 370: turn it, and k keeps it there" in hand.tuner.in_vain


def test_a_key_keeps_it_there(hand: Hand) -> None:
    hand.type(FAR_UP)
    for _ in range(4):
        hand.type(b"k", after=4.0)
    assert hand.ticks == (375, 380)


def test_straight_ahead_may_be_neutral_when_nobody_turned_it(hand: Hand) -> None:
    hand.go_to(2)
    hand.type(ENTER)
    assert hand.measuring.found == {"straight": pytest.approx(375 * TICK)}


def test_straight_ahead_is_neutral_after_a_turn_only_when_that_is_said_twice(hand: Hand) -> None:
    hand.go_to(2)
    hand.type(LEFT)
    hand.type(b"", after=6.0)
    hand.type(ENTER)
    assert "it went back to neutral, 375" in hand.tuner.in_vain
    assert hand.measuring.found == {}
    hand.type(ENTER)
    assert "straight" in hand.measuring.found


def test_a_note_is_gone_with_the_next_key(hand: Hand) -> None:
    hand.type(ENTER)
    assert hand.tuner.in_vain
    hand.type(UP)
    assert hand.tuner.in_vain == ""


def test_an_answer_that_cannot_be_is_said(hand: Hand) -> None:
    hand.type(FAR_UP)
    hand.type(ENTER)
    hand.type(FAR_UP)
    hand.type(ENTER)
    assert "other side of neutral" in hand.tuner.in_vain
    assert hand.measuring.step.find == "reverse starts"


def test_enter_twice_at_once_answers_one_question(hand: Hand) -> None:
    hand.type(FAR_UP)
    hand.type(ENTER + ENTER)
    assert list(hand.measuring.found) == ["forward starts"]


def test_it_ends_with_its_part_and_that_is_no_giving_up(hand: Hand) -> None:
    for _ in range(MOTOR_FIRST):
        assert not hand.tuner.finished
        hand.type(b"s")
    assert hand.tuner.finished
    assert not hand.tuner.gave_up


@pytest.mark.parametrize("key", [b"q", b"\x03"])
def test_whoever_quits_gave_up(hand: Hand, key: bytes) -> None:
    hand.type(UP)
    hand.type(key)
    assert hand.tuner.finished
    assert hand.tuner.gave_up
    assert hand.ticks == REST


def test_space_is_neutral_and_backspace_stops_the_robot(hand: Hand) -> None:
    hand.type(UP)
    hand.type(b" ")
    assert hand.ticks == REST
    hand.type(b"\x7f")
    assert hand.tuner.wish is Wish.STOP


def test_the_task_names_the_keys_of_its_axis(hand: Hand) -> None:
    assert hand.tuner.task()[0][1].startswith("up and down turn the throttle. Press enter when")
    hand.go_to(2)
    assert hand.tuner.task()[0][0] == "3 of 7"
    assert hand.tuner.task()[0][1].startswith("left and right turn the steering.")


def test_every_key_it_names_is_told_by_the_help(hand: Hand) -> None:
    assert hand.tuner.help == []
    hand.type(b"?")
    told = ", ".join(keys for keys, _ in hand.tuner.help)
    for key in ("up", "down", "pageup", "pagedown", "enter", "s", "b", "k", "space", "backspace", "r", "q"):
        assert key in told.split(", ")


def test_another_calibration_is_neutral(hand: Hand) -> None:
    hand.type(UP)
    hand.tuner.fit(to_vehicle(DriveSettings(servos=DONKEYCAR), TICK))
    assert hand.asked is None


def test_what_cannot_be_asked_again_is_said(hand: Hand) -> None:
    hand.type(b"b")
    assert hand.tuner.in_vain == "this is the first"
    hand.type(b"s")
    hand.type(b"b")
    assert hand.measuring.number == 0
    assert hand.tuner.in_vain == ""


def test_what_was_found_is_told_in_the_ticks_that_were_shown(hand: Hand) -> None:
    hand.go_to(2)
    hand.type(FAR_UP * 2)
    hand.type(ENTER)
    assert ("found", "straight 395") in hand.tuner.about
