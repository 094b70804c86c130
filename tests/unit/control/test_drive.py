"""The whole line, without a clock, a network or a chip; `now` is what the test says."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from unit.control.robot import FORWARD, NEUTRAL, REST, TICK_US, Robot, moves

from zteleop.control.cap import Strain
from zteleop.control.drive import Step
from zteleop.control.gate import Refusal
from zteleop.control.mixer import Differential
from zteleop.control.mux import Source
from zteleop.control.proof import LAPSE, Prover
from zteleop.control.report import status
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.messages import Pwm, Stop, Twist


def test_at_rest_every_channel_is_neutral() -> None:
    step = Robot().wait(0.1)
    assert (step.state, step.pulse_us) == ("idle", NEUTRAL)


def test_a_command_moves_within_one_step() -> None:
    robot = Robot()
    assert robot.say(Pwm(390, 370)) is None
    step = robot.drive.step(robot.now + 0.001)
    assert step.state == "driving"
    assert round(step.pulse_us[1] / TICK_US) == 390


@pytest.mark.parametrize("ticks", [(290, 220), (460, 500), (375, 371)])
def test_ticks_arrive_exactly_and_the_ends_are_inclusive(ticks: tuple[int, int]) -> None:
    robot = Robot()
    step = robot.hold(Pwm(*ticks), 1.0)
    assert (round(step.pulse_us[1] / TICK_US), round(step.pulse_us[0] / TICK_US)) == ticks
    assert robot.drive.clamped == 0


@pytest.mark.parametrize("ticks", [(289, 370), (461, 370), (375, 501), (375, -32768), (32767, 32767)])
def test_ticks_out_of_range_are_clamped_and_counted(ticks: tuple[int, int]) -> None:
    robot = Robot()
    step = robot.hold(Pwm(*ticks), 1.0)
    assert 290 <= round(step.pulse_us[1] / TICK_US) <= 460
    assert 220 <= round(step.pulse_us[0] / TICK_US) <= 500
    assert robot.drive.clamped > 0


def test_silence_brings_neutral_at_once_and_commands_resume() -> None:
    robot = Robot()
    assert moves(robot.hold(FORWARD, 0.5))
    step = robot.wait(0.3)
    assert (moves(step), step.state) == (False, "link lost")
    assert "keyboard 0001 has been silent for" in step.why
    assert not moves(robot.hold(FORWARD, 0.3, act=False))  # a lever asks for one more press
    assert moves(robot.hold(FORWARD, 0.2))


def test_after_a_long_silence_only_a_new_act_from_neutral_drives() -> None:
    robot = Robot()
    robot.provers["a"] = Prover(1, silence=float("inf"))  # an input that never admits its silence
    robot.hold(FORWARD, 0.5)
    robot.wait(2.5)
    assert not moves(robot.hold(FORWARD, 0.5))
    assert "let go first" in robot.drive.step(robot.now).why
    robot.say(REST)
    assert moves(robot.hold(FORWARD, 0.2))


def test_an_idle_operator_brings_neutral_and_the_next_act_drives_again() -> None:
    robot = Robot()
    robot.hold(Pwm(390, 400), 0.1)
    step = robot.hold(Pwm(390, 400), 5.2, act=False)
    assert (step.state, step.pulse_us) == ("operator idle", NEUTRAL)
    assert robot.say(Pwm(390, 400), act=True) is None
    assert moves(robot.drive.step(robot.now + 0.02))


def test_letting_go_is_neutral_at_once() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.5)
    robot.say(REST)
    step = robot.drive.step(robot.now)
    assert (step.state, moves(step)) == ("idle", False)


def test_a_second_sender_is_told_who_drives() -> None:
    robot = Robot()
    robot.say(FORWARD, "a")
    assert robot.say(FORWARD, "b") is Refusal.HELD
    assert robot.say(FORWARD, "b", source="web") is None
    assert robot.drive.step(robot.now).claim.source == "web"


def test_a_restart_forgets_a_held_key_until_it_is_let_go() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.5)
    robot.now += 0.5
    assert robot.drive.admission.late(robot.now)
    robot.epoch = 2
    robot.drive.admission.restart(2, robot.now)
    assert not moves(robot.hold(FORWARD, 1.0))
    robot.say(REST)
    assert moves(robot.hold(FORWARD, 0.2))


def test_a_sender_without_proof_is_refused_unless_trusted_by_arrival() -> None:
    robot = Robot(DriveSettings(sources={"nav": Source(10, silence=0.5, trust="arrival", max_speed=0.3)}))
    assert robot.drive.receive("keyboard", FORWARD, None, robot.now) is Refusal.UNPROVEN
    assert robot.drive.receive("nav", FORWARD, None, robot.now) is Refusal.NOT_FROM_NEUTRAL
    robot.wait(LAPSE + 0.1)
    for _ in range(20):
        assert robot.drive.receive("nav", FORWARD, None, robot.now) is None
        step = robot.wait(0.06)
    assert status(robot.drive, step, robot.chip(step), robot.now).applied.linear.x == pytest.approx(0.3)


def test_a_tank_takes_twists_and_refuses_ticks() -> None:
    servos = {"left": Servo(channel=0), "right": Servo(channel=1)}
    robot = Robot(DriveSettings(mixer=Differential(), servos=servos))
    assert robot.say(Pwm(390, 400)) is Refusal.NO_SUCH_CHANNEL
    assert robot.say(FORWARD) is None


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        (
            {"servos": {"throttle": Servo(channel=0)}},
            "expected servos steering, throttle, found throttle; what is written",
        ),
        (
            {"servos": {"throttle": Servo(channel=3), "steering": Servo(channel=3)}},
            "each servo needs a channel of its own, found steering, throttle on channel 3",
        ),
    ],
)
def test_impossible_vehicles_are_refused(changes: dict[str, dict[str, Servo]], words: str) -> None:
    with pytest.raises(ValueError, match=words):
        DriveSettings(**changes)


finite = st.floats(allow_nan=False, allow_infinity=False)


@given(st.lists(st.tuples(finite, finite), min_size=1, max_size=8))
def test_no_twist_leaves_the_calibration(twists: list[tuple[float, float]]) -> None:
    robot = Robot()
    for speed, turn in twists:
        robot.say(Twist.planar(speed, turn))
        step = robot.wait(0.04)
        assert 897.6 - 1e-6 <= step.pulse_us[0] <= 2040.0 + 1e-6
        assert 1183.2 - 1e-6 <= step.pulse_us[1] <= 1876.8 + 1e-6
        assert all(
            abs(pulse.fraction) <= 1
            for pulse in status(robot.drive, step, robot.chip(step), robot.now).pulses
        )


def test_a_stop_is_neutral_at_once_whoever_drives() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.5)
    assert robot.stop(7)
    step = robot.step()
    assert (step.state, moves(step)) == ("stopped", False)
    assert "stopped by ann" in step.why
    assert robot.say(FORWARD) is Refusal.AT_REST


def test_who_streams_through_a_long_stop_is_told_of_the_stop_and_then_of_its_release() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.5)
    robot.stop(7)
    told = set()
    for _ in range(100):
        robot.now += 0.05
        told.add(robot.say(FORWARD))
    assert told == {Refusal.AT_REST}
    robot.release(7)
    robot.now += 0.05
    assert robot.say(FORWARD) is Refusal.BEFORE_RELEASE


@pytest.mark.parametrize("state", ["stopped", "fault", "starting"])
def test_a_rest_that_is_over_is_no_reason_any_more(state: str) -> None:
    robot = Robot()
    rested(robot, state, on=True)
    robot.now += 0.05
    assert robot.say(FORWARD) is Refusal.AT_REST
    rested(robot, state, on=False)
    assert robot.step().why == "nobody drives"


def rested(robot: Robot, state: str, on: bool) -> None:
    """Keep a robot at rest for a reason of this state, or no longer."""
    if state == "stopped":
        (robot.stop if on else robot.release)(7)
    elif on:
        robot.drive.admission.hold("reason", state, "because", robot.now)
    else:
        robot.drive.admission.free("reason", robot.now)


@pytest.mark.parametrize("state", ["stopped", "fault", "starting"])
def test_a_key_held_through_a_rest_moves_nothing_until_it_is_let_go_and_pressed_again(state: str) -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    rested(robot, state, on=True)
    step = robot.hold(FORWARD, 0.5)
    assert (step.state, moves(step)) == (state, False)
    rested(robot, state, on=False)
    assert not moves(robot.step())
    assert not moves(robot.hold(FORWARD, 1.0))
    assert (
        robot.say(FORWARD)
        is {
            "stopped": Refusal.BEFORE_RELEASE,
            "fault": Refusal.BEFORE_REPAIR,
            "starting": Refusal.NOT_FROM_NEUTRAL,
        }[state]
    ), "whoever is refused is told the reason that holds"
    robot.say(REST)
    robot.wait(0.02)
    assert moves(robot.hold(FORWARD, 0.2))


def test_two_stops_hold_until_both_are_released() -> None:
    robot = Robot()
    for identity, by in ((7, "ann"), (8, "bob")):
        robot.drive.admission.stop(Stop(engaged=True, id=identity, by=by, why=""), robot.now)
    assert robot.release(8)
    assert robot.step().state == "stopped"
    assert "bob" not in robot.step().why
    assert robot.release(7)
    assert robot.step().state == "idle"


def test_a_key_pressed_while_at_rest_moves_nothing_afterwards() -> None:
    robot = Robot()
    robot.drive.admission.hold("chip", "fault", "", robot.now)
    robot.say(FORWARD)
    robot.wait(0.04)
    robot.drive.admission.free("chip", robot.now)
    assert not moves(robot.hold(FORWARD, 0.5))


def test_the_robot_is_free_when_every_reason_is_gone() -> None:
    robot = Robot()
    robot.drive.admission.hold("esc", "starting", "the ESC arms", robot.now)
    assert robot.step().state == "starting"
    robot.drive.admission.hold("chip", "fault", "the chip is silent", robot.now)
    assert (robot.step().state, robot.step().why) == ("fault", "the chip is silent")
    robot.stop(7)
    assert robot.step().state == "fault", "a stop hides no fault"
    robot.drive.admission.free("chip", robot.now)
    assert robot.step().state == "stopped"
    robot.release(7)
    assert (robot.step().state, robot.step().why) == ("starting", "the ESC arms")
    robot.drive.admission.free("esc", robot.now)
    assert robot.step().state == "idle"
    robot.wait(0.02)
    assert moves(robot.hold(FORWARD, 0.2))


def test_freeing_what_was_not_held_disturbs_nobody() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    robot.drive.admission.free("chip", robot.now)
    assert moves(robot.hold(FORWARD, 0.2))


def test_an_old_stop_that_is_heard_again_stops_nobody() -> None:
    robot = Robot()
    robot.stop(7)
    robot.release(7)
    robot.wait(0.02)
    robot.hold(FORWARD, 0.2)
    assert not robot.stop(7)
    assert moves(robot.step())


def test_a_sender_whose_process_is_gone_lets_go_at_once() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    robot.drive.admission.withdraw(1, robot.now)
    step = robot.step()
    assert (step.state, step.why, moves(step)) == (
        "link lost",
        "keyboard 0001 is not heard any more: ended, suspended or cut off; whoever begins drives",
        False,
    )
    assert robot.say(FORWARD, "b") is None  # and somebody else may take over
    robot.say(REST, "b")
    assert robot.step().state == "idle"
    assert moves(robot.hold(FORWARD, 0.2))  # or it is heard again


def test_the_departure_of_somebody_else_changes_nothing() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    robot.drive.admission.withdraw(2, robot.now)
    assert moves(robot.step())


def test_a_link_is_lost_until_nobody_may_go_on_any_more_and_then_nobody_drives() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    assert robot.wait(1.9).state == "link lost"
    rests = robot.wait(4.0)
    assert (rests.state, rests.why) == ("idle", "nobody drives; keyboard 0001 has been silent for 6.0 s")


def test_who_was_refused_and_lets_go_is_refused_no_more() -> None:
    robot = Robot()
    robot.drive.admission.hold("chip", "fault", "the chip is silent", robot.now)
    robot.say(FORWARD)
    robot.drive.admission.free("chip", robot.now)
    robot.say(FORWARD)
    assert "keyboard 0001 is refused: it was moving before" in robot.step().why
    robot.say(REST, "b")
    assert "keyboard 0001 is refused" in robot.step().why  # it was another who let go
    robot.say(REST)
    assert robot.step().why == "nobody drives"


def test_refusals_are_counted_by_sender_while_their_reason_lasts() -> None:
    robot = Robot()
    first = robot.now
    for _ in range(3):
        robot.drive.receive("web", FORWARD, None, robot.now)
        robot.wait(0.1)
    refusals = robot.drive.admission.refusals
    refused = refusals.recent(robot.now, 1.0)["web", 0]
    assert (refused.why, refused.times, refused.since) == (Refusal.UNPROVEN, 3, first)
    assert refused.at == pytest.approx(first + 0.2)
    robot.drive.admission.hold("chip", "fault", "the chip is silent", robot.now)
    robot.say(FORWARD, source="web")
    assert robot.step().why == "the chip is silent"  # which is what matters
    assert robot.drive.admission.refusals.recent(robot.now, 1.0)["web", 1][1:] == (
        Refusal.AT_REST,
        robot.now,
        robot.now,
        1,
    )
    assert robot.drive.admission.refusals.count == 4


def test_the_reason_of_a_refusal_is_told_for_a_second() -> None:
    robot = Robot()
    robot.drive.receive("web", FORWARD, None, robot.now)
    assert "web is refused: it carries no proof" in robot.wait(0.9).why
    assert robot.wait(0.2).why == "nobody drives"


def test_a_foreign_sender_does_not_drive_on_when_the_robot_was_stopped_for_a_while() -> None:
    robot = Robot(DriveSettings(sources={"nav": Source(10, silence=0.5, trust="arrival")}))
    robot.wait(LAPSE + 0.1)
    assert robot.drive.receive("nav", FORWARD, None, robot.now) is None
    robot.now += 3.0
    robot.drive.admission.restart(2, robot.now)
    robot.wait(0.02)
    assert robot.drive.receive("nav", FORWARD, None, robot.now) is Refusal.NOT_FROM_NEUTRAL
    assert robot.drive.receive("nav", REST, None, robot.now) is None
    robot.wait(0.02)
    assert robot.drive.receive("nav", FORWARD, None, robot.now) is None


def test_a_lever_pulled_while_another_drove_moves_nothing_until_it_begins_anew() -> None:
    robot = Robot()
    robot.say(FORWARD, "a")
    assert robot.say(Pwm(390, 400), "b") is Refusal.HELD
    robot.wait(0.06)
    robot.say(Twist.planar(), "a")
    for _ in range(10):
        assert robot.say(Pwm(390, 400), "b", act=False) is Refusal.WAITED
        assert not moves(robot.wait(0.06))
    for _ in range(10):
        assert robot.say(Pwm(390, 400), "b") is Refusal.WAITED
        assert not moves(robot.wait(0.06))
    robot.say(Pwm(375, 370), "b")
    assert robot.say(Pwm(390, 400), "b") is None
    assert moves(robot.wait(0.06))


def test_who_let_go_while_another_drove_may_drive_at_once_when_it_is_free() -> None:
    robot = Robot()
    robot.say(FORWARD, "a")
    assert robot.say(Pwm(390, 400), "b") is Refusal.HELD
    robot.say(Pwm(375, 370), "b")
    robot.say(Twist.planar(), "a")
    assert robot.say(Pwm(390, 400), "b") is None


FULL = Twist.planar(3.0, 3.0)
"""As fast as it can, on a curve of 1 m."""


def speed_of(robot: Robot, step: Step) -> float:
    return robot.drive.settings.mixer.unmix(step.wheels).linear.x


@pytest.mark.parametrize(("age", "speed"), [(0.05, 3.0), (0.14, 3.0), (0.2, 2.7), (0.29, 3 * 0.45 / 0.59)])
@pytest.mark.parametrize("command", [FULL, Pwm(400, 500)])
def test_the_later_the_commands_the_slower_at_the_same_steering(
    command: Twist | Pwm, age: float, speed: float
) -> None:
    robot, good = Robot(), Robot()
    for each in (robot, good):
        each.wait(1.0)
    step = robot.hold(command, 3.0, age=age)
    assert step.bound.speed == pytest.approx(speed, abs=0.01)
    assert speed_of(robot, step) == pytest.approx(speed, abs=0.01)
    assert step.wheels["steering"] == pytest.approx(good.hold(command, 3.0).wheels["steering"])


@pytest.mark.parametrize("command", [FULL, Pwm(400, 500)])
def test_a_cap_that_falls_or_rises_while_driving_moves_the_speed_within_the_acceleration(
    command: Twist | Pwm,
) -> None:
    robot = Robot()
    robot.wait(1.0)
    speed = speed_of(robot, robot.hold(command, 3.0))
    seen, age = [speed], 0.0
    for worst in (0.29, 0.05):
        for _ in range(150):
            age = min(worst, age + 0.02)  # a beat that goes back would be refused
            robot.say(command, age=age)
            robot.now += 0.05
            after = speed_of(robot, robot.drive.step(robot.now))
            assert abs(after - speed) <= 3.0 * 0.05 + 1e-9
            speed = after
        seen.append(speed)
    assert seen == [pytest.approx(3.0), pytest.approx(2.29, abs=0.01), pytest.approx(3.0)]


def test_no_cap_makes_a_slow_command_faster_or_slower() -> None:
    robot = Robot()
    robot.wait(1.0)
    assert speed_of(robot, robot.hold(FORWARD, 2.0, age=0.29)) == pytest.approx(0.5)


def test_a_command_that_is_too_late_counts_only_against_its_own_sender() -> None:
    robot = Robot()
    robot.wait(1.0)
    robot.hold(FULL, 2.0, sender="a")
    assert robot.say(FULL, "b", age=0.4) == Refusal.STALE
    assert robot.hold(FULL, 0.3).bound.latency == 0.0
    robot.wait(0.5)
    assert robot.say(FULL, "a", age=0.4) == Refusal.STALE
    step = robot.hold(FULL, 0.3)
    assert step.bound.latency == 0.3
    assert step.bound.by == "link"


def test_a_beat_of_the_future_is_refused_and_counts_for_nothing() -> None:
    robot = Robot()
    robot.hold(FULL, 1.0)
    assert robot.say(FULL, age=-5.0) == Refusal.STALE
    assert robot.hold(FULL, 0.3).bound == (3.0, "vehicle", 0.0)


def test_a_waiting_sender_with_a_bad_link_slows_nobody_down() -> None:
    robot = Robot()
    robot.wait(1.0)
    for _ in range(40):
        robot.say(FULL, "a", "keyboard")
        assert robot.say(FULL, "b", "keyboard", age=0.29) == Refusal.HELD
        robot.say(FULL, "c", "program", age=0.29)
        step = robot.wait(0.06)
    assert step.bound == (3.0, "vehicle", 0.0)


def test_a_sender_that_cannot_prove_its_age_counts_as_late_as_one_may_be() -> None:
    robot = Robot(DriveSettings(sources={"nav": Source(10, trust="arrival")}))
    for command in (REST, FULL):
        robot.drive.receive("nav", command, None, robot.now)
        robot.wait(0.04)
    assert robot.step().bound == (pytest.approx(2.25), "link", 0.3)


def test_a_strain_slows_down_whoever_drives_and_turns_as_before() -> None:
    robot = Robot()
    free = robot.hold(FULL, 2.0)
    robot.drive.movement.cap.bear(Strain(0.5, "undervoltage"))
    step = robot.hold(FULL, 2.0)
    assert speed_of(robot, step) == pytest.approx(1.5)
    assert step.wheels["steering"] == pytest.approx(free.wheels["steering"])


def test_standing_wheels_turn_under_any_cap() -> None:
    robot = Robot()
    robot.wait(1.0)
    robot.drive.movement.cap.bear(Strain(0.25, "heat"))
    step = robot.hold(Pwm(460, 370), 1.0, age=0.29)
    assert step.wheels == {"throttle": pytest.approx(0.0), "steering": pytest.approx(1.0, abs=0.01)}


def test_a_stop_is_no_softer_for_a_cap() -> None:
    robot = Robot()
    robot.wait(1.0)
    robot.hold(FULL, 2.0, age=0.29)
    robot.stop(7)
    assert not moves(robot.step())


def test_nobody_who_drives_is_bounded_by_the_vehicle_alone() -> None:
    assert Robot().step().bound == (3.0, "vehicle", 0.0)


def test_an_operator_who_must_act_more_often_is_held_to_it_from_the_next_step() -> None:
    robot = Robot()
    robot.drive.admission.operator_silence = 1.0
    assert robot.hold(FORWARD, 0.5).state == "driving"
    assert robot.hold(FORWARD, 0.6, act=False).state == "driving"
    step = robot.hold(FORWARD, 0.4, act=False)
    assert step.state == "operator idle"
    assert robot.say(FORWARD, act=False) is Refusal.OPERATOR_IDLE
