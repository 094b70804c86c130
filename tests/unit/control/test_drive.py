"""The whole line, without a clock, a network or a chip; `now` is what the test says."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from zteleop.control.drive import Drive, DriveSettings, Step
from zteleop.control.gate import Refusal
from zteleop.control.limiter import Limits
from zteleop.control.mixer import Differential
from zteleop.control.mux import Source
from zteleop.control.proof import Prover
from zteleop.control.report import status
from zteleop.control.servo import Servo
from zteleop.messages import Beat, Pwm, Twist

TICK_US = 4.08
NEUTRAL = {0: 1509.6, 1: 1530.0}
FORWARD = Twist.planar(0.5)


class Robot:
    """A drive and the senders around it, on one clock."""

    def __init__(self, drive_settings: DriveSettings | None = None) -> None:
        self.now, self.epoch = 100.0, 1
        self.drive = Drive(drive_settings or DriveSettings(), TICK_US, self.epoch, self.now)
        self.now += 0.02
        self.provers = {name: Prover(number) for number, name in enumerate("abc", 1)}

    def wait(self, seconds: float) -> Step:
        for _ in range(round(seconds * 50)):
            self.now += 0.02
            step = self.drive.step(self.now)
        return step

    def say(
        self, command: Twist | Pwm, sender: str = "a", source: str = "keyboard", act: bool = True
    ) -> Refusal | None:
        prover, beat = self.provers[sender], Beat(self.epoch, self.now)
        if act:
            prover.act(beat)
        moving = command not in (Twist.planar(), Pwm(375, 370))
        return self.drive.receive(source, command, prover.prove(beat, moving, self.now), self.now)

    def hold(self, command: Twist | Pwm, seconds: float, act: bool = True) -> Step:
        for _ in range(round(seconds * 20)):
            self.say(command, act=act)
            step = self.wait(0.06)
        return step


def moves(step: Step) -> bool:
    return step.pulse_us != NEUTRAL


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
    assert "keyboard has been silent for" in step.why
    assert moves(robot.hold(FORWARD, 0.2, act=False))


def test_after_a_long_silence_only_a_new_act_from_neutral_drives() -> None:
    robot = Robot()
    robot.provers["a"] = Prover(1, silence=float("inf"))  # an input that never admits its silence
    robot.hold(FORWARD, 0.5)
    robot.wait(2.5)
    assert not moves(robot.hold(FORWARD, 0.5))
    assert "let go first" in robot.drive.step(robot.now).why
    robot.say(Twist.planar())
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
    robot.say(Twist.planar())
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
    assert robot.drive.late(robot.now)
    robot.epoch = 2
    robot.drive.restart(2, robot.now)
    assert not moves(robot.hold(FORWARD, 1.0))
    robot.say(Twist.planar())
    assert moves(robot.hold(FORWARD, 0.2))


def test_a_sender_without_proof_is_refused_unless_trusted_by_arrival() -> None:
    robot = Robot(DriveSettings(sources={"nav": Source(10, silence=0.5, trust="arrival", max_speed=0.3)}))
    assert robot.drive.receive("keyboard", FORWARD, None, robot.now) is Refusal.UNPROVEN
    for _ in range(20):
        assert robot.drive.receive("nav", FORWARD, None, robot.now) is None
        step = robot.wait(0.06)
    assert status(robot.drive, step, robot.now).applied.linear.x == pytest.approx(0.3)


def test_a_tank_takes_twists_and_refuses_ticks() -> None:
    servos = {"left": Servo(channel=0), "right": Servo(channel=1)}
    robot = Robot(DriveSettings(mixer=Differential(), servos=servos))
    assert robot.say(Pwm(390, 400)) is Refusal.NO_SUCH_CHANNEL
    assert robot.say(FORWARD) is None


def test_status_tells_who_what_and_why() -> None:
    robot = Robot()
    step = robot.hold(Twist.planar(0.5, 0.5), 1.0)
    said = status(robot.drive, step, written=3.0)
    assert (said.state, said.source, said.operator, said.written) == ("driving", "keyboard", "1", 3.0)
    assert said.wanted == Twist.planar(0.5, 0.5)
    assert said.applied.linear.x == pytest.approx(0.5)
    assert said.applied.angular.z == pytest.approx(0.5)
    assert [pulse.name for pulse in said.pulses] == ["throttle", "steering"]


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"servos": {"throttle": Servo(channel=0)}}, "servos must be steering, throttle, found throttle"),
        (
            {"servos": {"throttle": Servo(channel=3), "steering": Servo(channel=3)}},
            r"each servo needs a channel of its own, found \[3, 3\]",
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
        assert all(abs(pulse.fraction) <= 1 for pulse in status(robot.drive, step, robot.now).pulses)


ACTS = st.one_of(
    st.tuples(st.just("say"), st.sampled_from("abc"), st.sampled_from(["keyboard", "web"]), st.booleans()),
    st.tuples(st.just("let go"), st.sampled_from("abc")),
    st.tuples(st.just("wait"), st.sampled_from([0.02, 0.1, 0.29, 0.31, 1.0, 2.1, 5.1])),
    st.tuples(st.just("delay"), st.sampled_from([0.0, 0.05, 0.2, 0.31, 3.0])),
    st.tuples(st.just("replay")),
    st.tuples(st.just("restart")),
)


@settings(max_examples=300, deadline=None)
@given(st.lists(ACTS, max_size=40))
def test_no_motion_without_a_fresh_acting_claim(acts: list[tuple]) -> None:
    """Whatever is delayed, replayed or restarted: who moves the robot has just acted, since its start."""
    robot, queue, started = Robot(DriveSettings(limits=Limits(acceleration=1000))), [], 100.0
    made: list[tuple[float, float]] = []  # when a moving command was made, and its operator acted
    acted = dict.fromkeys("abc", float("-inf"))
    delay = 0.0
    for act in acts:
        kind = act[0]
        if kind == "say":
            _, sender, source, fresh = act
            prover, beat = robot.provers[sender], Beat(robot.epoch, robot.now)
            if fresh:
                prover.act(beat)
                acted[sender] = robot.now
            made.append((robot.now, acted[sender]))
            queue.append((robot.now + delay, source, FORWARD, prover.prove(beat, True, robot.now)))
        elif kind == "let go":
            prover, beat = robot.provers[act[1]], Beat(robot.epoch, robot.now)
            queue.append((robot.now, "keyboard", Twist.planar(), prover.prove(beat, False, robot.now)))
        elif kind == "wait":
            robot.now += act[1]
        elif kind == "delay":
            delay = act[1]
        elif kind == "replay":
            queue += [(robot.now, *rest) for _, *rest in queue[-3:]]
        elif kind == "restart":
            robot.epoch += 1
            started = robot.now
            robot.drive.restart(robot.epoch, robot.now)
        for item in [item for item in queue if item[0] <= robot.now]:
            robot.drive.receive(item[1], item[2], item[3], robot.now)
        queue = [item for item in queue if item[0] > robot.now or kind == "say"]
        if moves(robot.drive.step(robot.now)):
            assert any(
                robot.now - at <= 0.3 + 0.3 and robot.now - when <= 5.0 and when > started
                for at, when in made
            )
