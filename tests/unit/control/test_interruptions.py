"""What an interruption takes, and what it leaves: each case of the rule by its name, in virtual time.

Up to 2 s since a command of a claim last counted, the claim keeps its right and its place; it drives on
with the first command whose beat and act are later than the end. Longer, and it must begin anew.
"""

import pytest
from unit.control.robot import FORWARD, REST, TICK_US, Robot, moves

from zteleop.control.drive import Drive
from zteleop.control.gate import Refusal
from zteleop.control.mux import Source
from zteleop.control.proof import NEVER, Prover
from zteleop.control.settings import DriveSettings
from zteleop.control.standing import NOBODY, go_on, stand
from zteleop.messages import Beat

STEP = 0.02


@pytest.fixture
def robot() -> Robot:
    robot = Robot()
    for name, prover in robot.provers.items():  # inputs that never admit a silence of their own
        robot.provers[name] = Prover(prover.sender, silence=float("inf"))
    return robot


def drives_on(robot: Robot, **how: object) -> bool:
    return moves(robot.hold(FORWARD, 0.3, **how))


def begins_anew(robot: Robot, sender: str = "a") -> bool:
    robot.say(REST, sender)
    robot.wait(STEP)
    return drives_on(robot, sender=sender)


def deaf_for(robot: Robot, seconds: float, **how: object) -> None:
    """Let the watchdog not hear the robot, while somebody goes on."""
    robot.drive.admission.pause("deaf", "", robot.now)
    assert not moves(robot.hold(FORWARD, seconds, **how))
    robot.drive.admission.resume("deaf", "it was deaf", robot.now)
    robot.wait(STEP)


def stand_still(robot: Robot, seconds: float) -> None:
    robot.now += seconds
    assert robot.drive.admission.late(robot.now) == pytest.approx(seconds)
    robot.drive.admission.interrupt("it stood still", robot.now, robot.drive.settings.deadlines.stand_still)


def test_a_link_lost_for_less_than_two_seconds(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    robot.wait(1.9)
    assert drives_on(robot)


def test_a_link_lost_for_more(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    robot.wait(2.1)
    assert not drives_on(robot)
    assert begins_anew(robot)


def test_a_deafness_of_less_than_two_seconds_and_of_more(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    deaf_for(robot, 1.0)
    assert drives_on(robot)
    deaf_for(robot, 2.0)
    assert not drives_on(robot)
    assert begins_anew(robot)


@pytest.mark.parametrize(("seconds", "goes_on"), [(0.3, True), (0.45, True), (0.55, False)])
def test_half_a_second_where_nobody_watched_the_chip(robot: Robot, seconds: float, goes_on: bool) -> None:
    robot.hold(FORWARD, 0.5)
    stand_still(robot, seconds - 0.06)  # beside what has passed since the last command
    assert drives_on(robot) is goes_on
    assert begins_anew(robot)


def test_what_was_said_before_the_end_counts_for_nothing(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    stand_still(robot, 0.25)
    assert robot.say(FORWARD, age=0.1) is Refusal.INTERRUPTED
    assert not moves(robot.step())
    robot.wait(STEP)
    assert robot.say(FORWARD) is None
    assert moves(robot.wait(STEP))


def test_a_lever_that_was_set_by_one_press_asks_for_one_more(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    stand_still(robot, 0.25)
    assert not drives_on(robot, act=False)
    robot.say(FORWARD)
    assert moves(robot.wait(STEP))


def test_a_lever_set_three_seconds_before_a_loss_of_almost_two(robot: Robot) -> None:
    robot.say(FORWARD)
    robot.hold(FORWARD, 2.5, act=False)
    robot.wait(1.85)
    assert not drives_on(robot, act=False)
    assert drives_on(robot)


def test_almost_two_seconds_and_then_a_beat_and_a_round_trip(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    robot.wait(1.9)
    assert robot.say(FORWARD, age=0.05) is Refusal.INTERRUPTED  # heard again; what it proves is from before
    robot.wait(0.2)
    assert drives_on(robot)


def test_two_losses_that_touch_are_one(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    robot.wait(1.5)
    robot.drive.admission.pause("deaf", "", robot.now)
    robot.hold(FORWARD, 0.6)
    robot.drive.admission.resume("deaf", "it was deaf", robot.now)
    assert not drives_on(robot)
    assert begins_anew(robot)


def test_a_loss_that_outlives_a_deafness_is_measured_from_the_last_command_obeyed(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    deaf_for(robot, 0.9)
    robot.wait(1.2)
    assert not drives_on(robot)
    assert begins_anew(robot)


def test_two_losses_with_driving_between_are_two(robot: Robot) -> None:
    for _ in range(3):
        assert drives_on(robot)
        robot.wait(1.7)
    assert drives_on(robot)


def test_a_stop_pressed_while_the_robot_was_cut_off_with_another_holding_a_key(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    robot.drive.admission.pause("deaf", "", robot.now)
    robot.hold(FORWARD, 0.7)
    robot.stop(7)
    robot.hold(FORWARD, 0.5)
    robot.drive.admission.resume("deaf", "it was deaf", robot.now)
    assert not drives_on(robot)
    robot.release(7)
    assert not drives_on(robot)
    assert begins_anew(robot)


def test_of_two_operators_the_one_who_drove_keeps_the_place(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5, sender="a")
    robot.wait(0.3)
    for _ in range(7):  # a is cut off; b presses meanwhile, and acts all along
        assert robot.say(FORWARD, "b") is Refusal.HELD
        assert not moves(robot.wait(0.2))
    assert drives_on(robot, sender="a")
    robot.say(REST, "a")
    assert not drives_on(robot, sender="b"), "whoever waited begins anew"
    assert begins_anew(robot, "b")


def test_who_waits_for_somebody_who_is_lost_is_told_when_that_one_has_lost_the_place(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5, sender="a")
    said = [robot.say(FORWARD, "b") for _ in range(30) if robot.wait(0.1)]
    assert said[:15] == [Refusal.HELD] * 15
    assert said[-5:] == [Refusal.WAITED] * 5


def test_of_two_operators_the_one_who_waits_has_it_when_the_other_is_gone(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5, sender="a")
    assert robot.say(FORWARD, "b") is Refusal.HELD
    robot.drive.admission.withdraw(1, robot.now)
    assert not drives_on(robot, sender="b")
    assert begins_anew(robot, "b")


def test_whoever_begins_during_an_interruption_begins_too_early(robot: Robot) -> None:
    robot.drive.admission.pause("deaf", "", robot.now)
    robot.hold(FORWARD, 1.0)
    robot.drive.admission.resume("deaf", "it was deaf", robot.now)
    assert not drives_on(robot)
    assert begins_anew(robot)


def test_letting_go_during_an_interruption_gives_the_right_away(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    robot.drive.admission.pause("deaf", "", robot.now)
    robot.say(REST)
    robot.hold(FORWARD, 0.5)
    robot.drive.admission.resume("deaf", "it was deaf", robot.now)
    assert not drives_on(robot)
    assert begins_anew(robot)


def test_an_idle_operator_still_drives_with_the_next_act_however_late(robot: Robot) -> None:
    robot.say(FORWARD)
    robot.hold(FORWARD, 8.0, act=False)
    assert drives_on(robot)


def take_over(robot: Robot, seconds: float, released: float = NEVER) -> None:
    """End the drive for being late, and let another take its place some time later."""
    standing = stand(robot.drive, 100.0)
    robot.now += seconds
    robot.drive = Drive(robot.drive.settings, TICK_US, robot.epoch, robot.now)
    go_on(robot.drive, standing._replace(floor=max(standing.floor, released)), "it came late", robot.now)
    robot.wait(STEP)


def test_an_actuator_that_was_ended_for_being_late_is_an_interruption(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    take_over(robot, 1.0)
    assert not moves(robot.step()), "the next act, and not the last"
    assert robot.step().why == "it came late; keyboard 0001 goes on with its next act"
    assert drives_on(robot)


def test_another_actuator_asks_a_lever_for_one_more_press(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    take_over(robot, 1.0)
    assert not drives_on(robot, act=False)
    assert drives_on(robot)


def test_another_actuator_that_comes_too_late_is_a_start(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    take_over(robot, 2.0)
    assert not drives_on(robot)
    assert begins_anew(robot)


def test_an_actuator_that_was_late_twice_is_measured_from_the_last_command_obeyed(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    take_over(robot, 1.2)
    take_over(robot, 0.9)
    assert not drives_on(robot)
    assert begins_anew(robot)


def test_another_actuator_keeps_the_place_of_whoever_drove(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5, sender="a")
    assert robot.say(FORWARD, "b") is Refusal.HELD
    take_over(robot, 0.8)
    robot.say(REST, "b")
    robot.wait(STEP)
    assert robot.say(FORWARD, "b") is Refusal.HELD
    assert drives_on(robot, sender="a")
    robot.say(REST, "a")
    assert not drives_on(robot, sender="b"), "whoever waited begins anew"


def test_another_actuator_knows_nobody_but_whoever_drove(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5, sender="b", source="program")
    robot.hold(FORWARD, 0.5, sender="a")
    robot.say(FORWARD, "b", "program")
    take_over(robot, 0.8)
    robot.say(REST, "a")
    assert not drives_on(robot, sender="b", source="program")
    assert begins_anew(robot, "a")


def test_whoever_had_let_go_does_not_drive_on_under_another_actuator(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    robot.say(REST)
    robot.wait(STEP)
    take_over(robot, 0.5)
    robot.provers["a"].prove(Beat(robot.epoch, robot.now, 0.0), True, robot.now)  # its last claim, once more
    assert stand(robot.drive, 100.0).source == NOBODY


def test_a_stop_that_came_and_went_while_no_actuator_stepped_ends_every_right(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    take_over(robot, 1.0, released=robot.now + 0.5)
    assert not drives_on(robot)
    assert begins_anew(robot)


def test_the_release_of_a_stop_that_never_arrived_ends_every_claim(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    assert robot.release(7)
    assert not drives_on(robot)
    assert begins_anew(robot)
    assert not robot.release(7), "said again, it is no news"
    assert drives_on(robot)


def test_a_claim_that_is_over_is_not_kept_by_an_idle_operator(robot: Robot) -> None:
    """Idle, and lost for long: its next word lacks an act, but not only that."""
    robot.say(FORWARD)
    robot.hold(FORWARD, 0.5, act=False)
    robot.wait(5.0)
    robot.hold(FORWARD, 0.3, act=False)
    robot.drive.admission.pause("deaf", "", robot.now)
    robot.drive.admission.resume("deaf", "it was deaf", robot.now)
    robot.wait(STEP)
    assert not drives_on(robot)
    assert begins_anew(robot)


def test_a_planner_drives_on_under_another_actuator_and_one_that_was_too_late_pauses() -> None:
    for seconds, goes_on in ((1.0, True), (2.5, False)):
        robot = planned(PLANNER)
        take_over(robot, seconds)
        moved = []
        for _ in range(20):
            plan(robot)
            moved.append(moves(robot.wait(0.06)))
        assert moved[:4] == [False] * 4
        assert moved[-1] is goes_on


def test_a_slow_planner_that_never_paused_does_not_begin_by_being_refused() -> None:
    """What arrives too early after the end is refused, and still no pause."""
    robot = planned(PLANNER)
    robot.drive.admission.pause("deaf", "", robot.now)
    robot.drive.admission.resume("deaf", "it was deaf", robot.now)
    robot.wait(0.26)
    assert plan(robot) is Refusal.INTERRUPTED
    robot.release(7)
    robot.wait(0.3)
    assert plan(robot) is Refusal.BEFORE_RELEASE


PLANNER = Source(10, silence=0.5, trust="arrival")


def plan(robot: Robot, moving: bool = True) -> Refusal | None:
    return robot.drive.receive("nav", FORWARD if moving else REST, None, robot.now)


def planned(source: Source) -> Robot:
    robot = Robot(DriveSettings(sources={"nav": source}))
    plan(robot, moving=False)
    robot.wait(STEP)
    for _ in range(5):
        plan(robot)
        assert moves(robot.wait(0.06))
    return robot


def test_a_dead_planners_queued_command_after_an_interruption_moves_nothing() -> None:
    robot = planned(PLANNER)
    robot.drive.admission.pause("deaf", "", robot.now)
    robot.wait(1.5)
    robot.drive.admission.resume("deaf", "it was deaf", robot.now)
    robot.wait(0.1)
    assert plan(robot) is Refusal.INTERRUPTED
    assert not moves(robot.wait(0.3))


def test_a_planner_that_lives_drives_on_once_nothing_old_can_arrive() -> None:
    robot = planned(PLANNER)
    robot.drive.admission.pause("deaf", "", robot.now)
    robot.wait(1.0)
    robot.drive.admission.resume("deaf", "it was deaf", robot.now)
    moved = []
    for _ in range(10):
        plan(robot)
        moved.append(moves(robot.wait(0.06)))
    assert moved[:4] == [False] * 4
    assert moved[-1]


@pytest.mark.parametrize("resume", [False, True])
def test_after_a_start_a_planner_pauses_unless_its_owner_said_otherwise(resume: bool) -> None:
    source = Source(10, silence=0.5, trust="arrival", resume=resume)
    robot = Robot(DriveSettings(sources={"nav": source}))
    for _ in range(10):
        plan(robot)
        step = robot.wait(0.1)
    assert moves(step) is resume


def test_whoever_can_prove_what_is_said_never_drives_on_after_a_start() -> None:
    with pytest.raises(ValueError, match=r'resume is for trust = "arrival", found it at sources\.nav'):
        DriveSettings(sources={"nav": Source(10, resume=True)})


@pytest.mark.parametrize("seconds", [0.6, 1.5, 1.94, 1.98, 2.0, 2.02, 2.06, 2.1, 2.2, 3.0])
def test_a_program_that_paused_begins_anew_however_long_it_paused(seconds: float) -> None:
    """Its beats are a little old, so two seconds after its last word it may begin a little before that."""
    robot = Robot()
    assert moves(robot.hold(FORWARD, 0.5))
    robot.wait(seconds)
    assert moves(robot.hold(FORWARD, 0.3, age=0.1))


def test_who_waits_to_go_on_is_told_once_and_is_not_said_to_be_refused() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    robot.drive.admission.interrupt("it stood still", robot.now, 2.0)
    robot.say(FORWARD, act=False)
    assert robot.step().why == "it stood still; keyboard 0001 goes on with its next act"


def test_a_pause_that_began_with_an_interruption_is_told_as_that_one() -> None:
    robot = Robot()
    robot.hold(FORWARD, 0.2)
    robot.drive.admission.interrupt("its actuator came late", robot.now, 2.0)
    robot.drive.admission.pause("deaf", "the watchdog does not hear it", robot.now)
    assert robot.step().why == "the watchdog does not hear it"
    robot.now += 0.1
    robot.drive.admission.resume("deaf", "the watchdog did not hear it", robot.now)
    assert robot.step().why.startswith("its actuator came late; ")
    robot.now += 0.1
    robot.drive.admission.pause("deaf", "the watchdog does not hear it", robot.now)
    robot.now += 0.1
    robot.drive.admission.resume("deaf", "the watchdog did not hear it", robot.now)
    assert robot.step().why.startswith("the watchdog did not hear it; ")


def test_whoever_talks_on_without_an_act_is_not_told_that_he_is_silent(robot: Robot) -> None:
    """A keyboard in steps, whose levers stand: it repeats what it was told before its link was lost."""
    robot.hold(FORWARD, 0.5)
    robot.wait(0.5)
    assert not moves(robot.hold(FORWARD, 0.5, act=False))
    waits = "keyboard 0001 was not heard for more than 0.3 s, and waits for a new act"
    assert robot.drive.admission.rest(robot.now) == ("link lost", waits)
    robot.hold(FORWARD, 2.5, act=False)
    state, why = robot.drive.admission.rest(robot.now)
    assert (state, "silent" in why) == ("idle", False)


def test_who_talks_again_after_too_long_is_not_said_to_be_silent(robot: Robot) -> None:
    """As a program with a long handler: what it says is refused, and nothing grows but the refusals."""
    robot.hold(FORWARD, 0.5)
    robot.wait(3.0)
    assert not drives_on(robot)
    state, why = robot.drive.admission.rest(robot.now)
    assert (state, why.partition(":")[0]) == ("idle", "nobody drives; keyboard 0001 is refused")


def test_who_is_back_and_refused_is_not_called_gone(robot: Robot) -> None:
    """As a program that was suspended until it was missed."""
    robot.hold(FORWARD, 0.5)
    robot.drive.admission.withdraw(1, robot.now)
    robot.wait(3.0)
    assert "not heard any more" in robot.step().why
    assert not drives_on(robot)
    step = robot.step()
    assert (step.state, step.why.partition(":")[0]) == ("idle", "nobody drives; keyboard 0001 is refused")


def test_who_is_back_in_time_is_told_of_his_next_act(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    robot.drive.admission.withdraw(1, robot.now)
    robot.wait(0.5)
    robot.hold(FORWARD, 0.1, act=False)
    gone = "keyboard 0001 is not heard any more: ended, suspended or cut off; whoever begins drives"
    assert robot.step().why == gone


def test_whoever_is_silent_is_called_so_while_another_is_refused(robot: Robot) -> None:
    robot.hold(FORWARD, 0.5)
    assert robot.say(FORWARD, "b") is Refusal.HELD
    robot.wait(0.5)
    assert "keyboard 0001 has been silent for 0." in robot.step().why


@pytest.mark.parametrize("seconds", [0.3, 0.7])
def test_who_lacks_more_than_an_act_is_not_said_to_go_on_with_one(robot: Robot, seconds: float) -> None:
    robot.hold(FORWARD, 0.5)
    stand_still(robot, seconds)
    robot.hold(FORWARD, 0.1)
    robot.drive.admission.interrupt("it stood still", robot.now, 0.0)
    robot.hold(FORWARD, 0.1)
    why = robot.step().why
    assert "keyboard 0001 is refused: " in why
    assert "goes on" not in why


@pytest.mark.parametrize("early", [0.0, 0.05])
def test_who_lets_go_for_want_of_an_act_is_told_as_the_reason_until_another_drives(
    robot: Robot, early: float
) -> None:
    robot.say(FORWARD)
    acted = robot.now
    while robot.now - acted < 5.0 - early - STEP:
        robot.say(FORWARD, act=False)
        robot.wait(STEP)
    robot.say(REST, act=False)
    for _ in range(3):
        assert (robot.step().state, robot.step().why) == (
            "idle",
            "nobody drives; keyboard 0001 had not acted for 5 s",
        )
        robot.wait(1.0)
        robot.say(REST, act=False)  # again and again, as an input does
    assert begins_anew(robot)
    robot.say(REST)
    assert robot.step().why == "nobody drives"


def test_after_a_stop_the_reason_is_no_longer_that_somebody_did_not_act(robot: Robot) -> None:
    robot.say(FORWARD)
    acted = robot.now
    while robot.now - acted < 5.0 - STEP:
        robot.say(FORWARD, act=False)
        robot.wait(STEP)
    robot.say(REST, act=False)
    assert "had not acted" in robot.step().why
    robot.stop(7)
    robot.release(7)
    assert robot.step().why == "nobody drives"
