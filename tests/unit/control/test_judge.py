"""The watchdog's opinion, beside a drive that does as it must and beside chips that do not."""

import pytest
from unit.control.robot import FORWARD, NEUTRAL, REST, TICK_US, Robot, moves

from zteleop.control.cap import Strain
from zteleop.control.deadlines import GRACE
from zteleop.control.drive import Drive, Step
from zteleop.control.gate import SENDERS, Refusal
from zteleop.control.judge import LOOKS, Judge
from zteleop.control.mux import Source
from zteleop.control.proof import LAPSE, Proof, Prover
from zteleop.control.settings import DriveSettings
from zteleop.control.standing import Standing
from zteleop.messages import Beat, Pwm, Stop, Twist

MOVING = {0: 1600.0, 1: 1530.0}
LOOK = 0.05
SETTINGS = DriveSettings(sources={"nav": Source(10, silence=0.5, trust="arrival")})


def begun(epoch: int, since: float) -> Standing:
    return Standing(epoch, since, since, since)


class Watched(Robot):
    """A robot whose judge hears what its drive hears, and looks at its chip 20 times a second."""

    def __init__(self) -> None:
        super().__init__(SETTINGS)
        self.judge = Judge(SETTINGS, TICK_US, self.now)
        self.judge.hear_report(begun(self.epoch, 100.0))
        self.pulses: dict[int, float] | None = None
        """What the chip does instead of what the drive says."""
        self.looked = self.now
        self.why: str | None = None

    def say(self, command: Twist | Pwm, sender="a", source="keyboard", act=True, age=0.0) -> Refusal | None:
        prover, beat = self.provers[sender], Beat(self.epoch, self.now - age, self.drive.admission.gate.floor)
        if act:
            prover.act(beat)
        return self.tell(source, command, prover.prove(beat, command != REST, self.now))

    def tell(self, source: str, command: Twist | Pwm, proof: Proof | None) -> Refusal | None:
        self.judge.receive(source, command, proof, self.now + 0.01)
        return self.drive.receive(source, command, proof, self.now)

    def wait(self, seconds: float) -> Step:
        step = self.step()
        for _ in range(round(seconds * 50)):
            step = super().wait(0.02)
            if self.now - self.looked >= LOOK - 1e-9:
                self.looked = self.now
                self.why = self.judge.look(self.pulses or step.pulse_us, self.now) or self.why
        return step

    def until_engaged(self, patience: float = 10.0) -> float:
        """Return after how long the judge engages."""
        start = self.now
        while self.why is None and self.now < start + patience:
            self.wait(0.02)
        return self.now - start

    def rest(self, on: bool) -> None:
        (self.stop if on else self.release)(7)
        self.judge.rest(on, self.now)


@pytest.fixture
def robot() -> Watched:
    return Watched()


SOON = GRACE + (LOOKS + 1) * LOOK


def test_it_has_nothing_to_say_of_a_robot_at_rest(robot: Watched) -> None:
    robot.wait(3.0)
    assert (robot.why, robot.judge.moving, robot.judge.allowed(robot.now)) == (None, False, False)


def test_who_drives_moves_and_may(robot: Watched) -> None:
    assert moves(robot.hold(FORWARD, 2.0))
    assert (robot.why, robot.judge.moving, robot.judge.allowed(robot.now)) == (None, True, True)


@pytest.mark.parametrize(
    "end",
    [
        lambda robot: robot.say(REST),
        lambda robot: robot.wait(0.6),
        lambda robot: robot.hold(FORWARD, 6.0, act=False),
        lambda robot: robot.rest(True),
        lambda robot: robot.drive.admission.hold("chip", "fault", "", robot.now),
        lambda robot: robot.drive.admission.withdraw(1, robot.now),
    ],
    ids=["let go", "silence", "idle operator", "stop", "fault", "departure"],
)
def test_it_agrees_with_a_drive_that_comes_to_rest_and_drives_again(robot: Watched, end) -> None:
    robot.hold(FORWARD, 0.5)
    end(robot)
    assert not moves(robot.wait(1.0))
    robot.say(REST)
    robot.drive.admission.free("chip", robot.now)
    robot.rest(False)
    robot.wait(0.1)
    assert moves(robot.hold(FORWARD, 1.0))
    assert robot.why is None


def test_pulses_without_a_claim_are_stopped_at_the_second_look(robot: Watched) -> None:
    robot.pulses = MOVING
    assert robot.until_engaged() == pytest.approx(LOOKS * LOOK, abs=0.03)
    assert robot.why == "its pulses moved although nobody drives"


def test_one_bad_look_is_forgiven(robot: Watched) -> None:
    assert robot.judge.look(MOVING, robot.now) is None
    assert robot.judge.look(NEUTRAL, robot.now + 0.05) is None
    assert robot.judge.look(MOVING, robot.now + 0.1) is None
    assert robot.judge.look(MOVING, robot.now + 0.15)


def test_what_moved_before_its_command_was_heard_is_forgiven(robot: Watched) -> None:
    assert robot.judge.look(MOVING, robot.now) is None
    robot.say(FORWARD)
    robot.judge.rest(True, robot.now)
    assert robot.judge.look(MOVING, robot.now + GRACE + 0.05) is None
    assert robot.judge.look(MOVING, robot.now + GRACE + 0.1)


def test_a_chip_that_moves_on_after_the_operators_time_is_stopped(robot: Watched) -> None:
    robot.pulses = MOVING
    robot.say(FORWARD)
    began = robot.now
    while robot.why is None and robot.now < began + 10:
        robot.hold(FORWARD, 0.05, act=False)
    assert 5.0 + GRACE < robot.now - began <= 5.0 + SOON
    assert "no act on keyboard" in robot.why


@pytest.mark.parametrize(("source", "silence"), [("keyboard", 0.3), ("program", 0.5)])
def test_a_chip_that_moves_on_after_a_sources_silence_is_stopped(
    robot: Watched, source: str, silence: float
) -> None:
    robot.pulses = MOVING
    robot.say(FORWARD, source=source)
    assert silence + GRACE < robot.until_engaged() <= silence + SOON + 0.03
    assert f"{source} 0001 has been silent" in robot.why


def test_a_chip_that_does_not_obey_a_stop_is_stopped_after_the_grace_and_not_before(robot: Watched) -> None:
    robot.hold(FORWARD, 0.5)
    robot.pulses = MOVING
    robot.rest(True)
    assert robot.judge.stopped
    start = robot.now
    while robot.why is None and robot.now < start + 10:
        robot.hold(FORWARD, 0.05)
        robot.judge.rest(True, robot.now)
    assert GRACE < robot.now - start <= SOON + 0.05
    assert robot.why == "its pulses moved although a stop is in force"


def test_a_stop_does_not_excuse_what_had_no_claim_before(robot: Watched) -> None:
    robot.pulses = MOVING
    robot.rest(True)
    assert robot.until_engaged() <= (LOOKS + 1) * LOOK
    assert robot.judge.stopped


def test_a_chip_that_moves_on_into_a_new_epoch_is_stopped(robot: Watched) -> None:
    robot.hold(FORWARD, 0.5)
    robot.pulses = MOVING
    robot.judge.hear_report(begun(2, robot.now))
    assert robot.until_engaged() <= SOON


def test_the_report_of_a_new_epoch_ends_all_claims_and_the_same_report_none(robot: Watched) -> None:
    robot.hold(FORWARD, 0.5)
    robot.judge.hear_report(begun(1, 100.0))
    assert robot.judge.allowed(robot.now)
    robot.judge.hear_report(begun(2, robot.now))
    assert not robot.judge.allowed(robot.now)
    robot.hold(FORWARD, 0.2)  # still of the old epoch
    assert not robot.judge.allowed(robot.now)
    robot.epoch = 2
    robot.hold(FORWARD, 0.2)  # never let go
    assert not robot.judge.allowed(robot.now)
    robot.say(REST)
    robot.say(FORWARD)
    assert robot.judge.allowed(robot.now + 0.01)


def test_before_the_first_report_nobody_may_drive(robot: Watched) -> None:
    robot.judge = Judge(SETTINGS, TICK_US, robot.now)
    robot.hold(FORWARD, 0.2)
    assert not robot.judge.allowed(robot.now)


def test_a_release_gives_it_back_to_who_begins_anew(robot: Watched) -> None:
    robot.hold(FORWARD, 0.5)
    robot.rest(True)
    robot.hold(FORWARD, 1.0)
    robot.judge.rest(True, robot.now)
    robot.rest(False)
    robot.wait(GRACE)
    assert not robot.judge.allowed(robot.now)
    robot.say(REST)
    robot.wait(0.02)
    robot.say(FORWARD)
    assert robot.judge.allowed(robot.now + 0.01)


def test_who_drives_on_through_a_stop_is_not_given_it_back(robot: Watched) -> None:
    robot.hold(FORWARD, 0.5)
    robot.rest(True)
    for _ in range(20):
        robot.hold(FORWARD, 0.05)
        robot.judge.rest(True, robot.now)
    robot.rest(False)
    robot.pulses = MOVING
    for _ in range(20):
        robot.hold(FORWARD, 0.05)
    assert robot.why


def test_whoever_talked_through_a_stop_is_let_pass_by_nobody_after_its_release(robot: Watched) -> None:
    robot.say(FORWARD)
    robot.rest(True)
    for _ in range(20):
        robot.wait(0.05)
        robot.say(FORWARD)
        robot.judge.rest(True, robot.now)
    robot.say(FORWARD)  # in the moment between the judge's last look at the stop and the release
    robot.rest(False)
    for _ in range(20):
        assert not robot.judge.allowed(robot.now)
        robot.wait(0.05)
        assert robot.say(FORWARD) is Refusal.BEFORE_RELEASE


def test_a_command_heard_before_the_release_it_follows_counts(robot: Watched) -> None:
    robot.rest(True)
    robot.wait(1.0)
    robot.judge.rest(True, robot.now)
    robot.release(7)
    robot.wait(0.02)
    robot.say(FORWARD, source="program")
    robot.judge.rest(False, robot.now)
    robot.wait(0.4)
    assert (robot.judge.moving, robot.why) == (True, None)


@pytest.mark.parametrize("pause", [0.31, 0.4, 0.55, 0.7])
def test_a_second_sender_may_take_over_a_silent_ones_source(robot: Watched, pause: float) -> None:
    robot.say(FORWARD, "a", "program")
    robot.wait(2.02)
    assert robot.say(FORWARD, "b", "program") is None
    robot.wait(pause)
    robot.say(FORWARD, "b", "program")
    robot.wait(1.5)
    assert robot.why is None


def test_a_second_sender_may_take_over_from_one_that_is_gone(robot: Watched) -> None:
    robot.hold(FORWARD, 0.3)
    robot.drive.admission.withdraw(1, robot.now)
    assert moves(robot.hold(FORWARD, 1.0, sender="b"))
    assert robot.why is None


def test_a_refused_second_sender_that_lets_go_takes_nothing_away(robot: Watched) -> None:
    robot.say(FORWARD, "a", "program")
    assert robot.say(FORWARD, "b", "program") is Refusal.HELD
    robot.say(REST, "b", "program")
    robot.wait(0.5)
    assert robot.why is None


@pytest.mark.parametrize("pause", [2.04, 2.24, 2.26, 2.3, 3.0])
def test_a_program_that_publishes_seldom_is_let_drive(robot: Watched, pause: float) -> None:
    """However the link's deadline falls between its claim's beginning and its arrival."""
    for late in (0.0, 0.1, 0.2):
        robot.wait(pause - 0.3)
        prover, beat = robot.provers["a"], Beat(1, robot.now, 0.0)
        prover.act(beat)
        proof = prover.prove(beat, True, robot.now)
        robot.wait(late)
        robot.tell("program", FORWARD, proof)
        robot.wait(0.3)
        assert robot.why is None


def test_a_late_command_that_the_drive_refused_makes_no_later_one_suspect(robot: Watched) -> None:
    robot.say(REST)
    robot.wait(0.1)
    prover, made = Prover(1), robot.now
    late = Proof(1, 5, 1, made, made, made)
    robot.wait(0.4)
    assert robot.tell("keyboard", FORWARD, late) is Refusal.STALE
    began = robot.now + 1.0
    robot.wait(2.5)
    now = robot.now
    assert robot.tell("keyboard", FORWARD, Proof(prover.sender, 6, 1, now, now, began)) is None
    robot.wait(0.3)
    assert robot.why is None


def test_a_foreign_sender_trusted_by_arrival_may_drive_until_its_silence(robot: Watched) -> None:
    robot.wait(LAPSE + 0.1)
    for _ in range(30):
        assert robot.tell("nav", FORWARD, None) is None
        robot.wait(0.1)
    assert robot.why is None
    robot.pulses = MOVING
    assert 0.5 + GRACE - 0.1 < robot.until_engaged() <= 0.5 + SOON
    assert "nav has been silent" in robot.why


@pytest.mark.parametrize("gap", [0.5, 0.502, 0.51, 0.6])
def test_a_foreign_sender_that_begins_anew_for_the_drive_does_so_for_the_judge(
    robot: Watched, gap: float
) -> None:
    """The judge hears it at other times, and its pauses a little shorter."""
    robot.wait(0.6)
    for _ in range(10):
        robot.tell("nav", FORWARD, None)
        robot.wait(0.1)
    robot.rest(True)
    robot.rest(False)
    robot.judge.receive("nav", FORWARD, None, robot.now + 0.02)
    robot.drive.receive("nav", FORWARD, None, robot.now)
    robot.now += gap
    judged = robot.judge.receive("nav", FORWARD, None, robot.now)
    assert judged is None or robot.drive.receive("nav", FORWARD, None, robot.now)


def test_a_command_just_young_enough_for_the_drive_is_so_for_the_judge(robot: Watched) -> None:
    made = robot.now
    robot.now += 0.295
    assert robot.tell("keyboard", FORWARD, Proof(1, 1, 1, made, made, made)) is None
    assert robot.judge.allowed(robot.now + 0.01)


def test_a_letting_go_that_the_judge_alone_heard_is_no_fault(robot: Watched) -> None:
    robot.hold(FORWARD, 0.2)
    now = robot.now
    robot.judge.receive("keyboard", REST, Proof(1, 9999, 1, now, now, now), now)
    robot.wait(0.3)
    assert robot.why is None


def test_a_source_without_proof_is_not_trusted(robot: Watched) -> None:
    assert robot.judge.receive("keyboard", FORWARD, None, robot.now) is Refusal.UNPROVEN
    assert not robot.judge.allowed(robot.now)


def test_its_memory_is_bounded_and_keeps_who_drives(robot: Watched) -> None:
    for sender in range(10, 3 * SENDERS):
        robot.say(FORWARD)
        now = robot.now
        robot.tell("program", FORWARD, Proof(sender, 1, 1, now, now, now))
        claims = robot.judge._admission.mux.claims
        assert len(claims) <= SENDERS
        assert any(claim.sender == 1 for claim in claims)
        robot.wait(0.02)


def test_half_a_tick_is_rest_and_an_output_that_is_off_too(robot: Watched) -> None:
    half = TICK_US / 2
    assert robot.judge.at_rest({0: 1509.6 + half, 1: None})
    assert not robot.judge.at_rest({0: 1509.6, 1: 1530.0 - half - 0.01})


def test_a_speed_cap_gives_the_judge_nothing_to_blame(robot: Watched) -> None:
    robot.wait(1.0)
    robot.drive.movement.cap.bear(Strain(0.5, "undervoltage"))
    for age in (0.29, 0.0):
        step = robot.hold(Twist.planar(3.0), 3.0, age=age)
        assert step.bound.by == "strain"
        assert moves(step)
        assert robot.why is None
        assert robot.judge.allowed(robot.now)


def test_a_judge_that_looks_late_does_not_blame_who_began_after_the_release() -> None:
    settings = DriveSettings()
    drive, judge = Drive(settings, TICK_US, 1, 0.0), Judge(settings, TICK_US, 0.0)
    judge.hear_report(begun(1, 0.0))
    drive.admission.stop(Stop(engaged=True, id=5, by="ann", why=""), 1.0)
    judge.rest(True, 2.0)
    drive.admission.stop(Stop(engaged=False, id=5, by="ann", why=""), 2.01)
    prover, waiting = Prover(1), []
    for now in (2.06 + 0.02 * number for number in range(60)):
        prover.act(Beat(1, now, 0.0))
        waiting.append(prover.prove(Beat(1, now, 0.0), True, now))
        drive.receive("keyboard", Pwm(390, 400), waiting[-1], now)
        pulses = drive.step(now).pulse_us
        if now >= 2.38:
            for proof in waiting:
                judge.receive("keyboard", Pwm(390, 400), proof, now)
            waiting.clear()
            judge.rest(False, now)
            assert judge.look(pulses, now) is None
    assert judge.moving
