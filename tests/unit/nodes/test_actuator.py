import pytest
from unit.bus.fakes import Clock
from unit.nodes.fakes import Node

from zteleop.bus.subscription import Received
from zteleop.control.drive import SOURCES, DriveSettings
from zteleop.control.mux import Source
from zteleop.control.proof import Proof, Prover
from zteleop.errors import DeviceError, MessageError
from zteleop.messages import (
    Beat,
    Header,
    Int16MultiArray,
    Message,
    MultiArrayLayout,
    Pwm,
    String,
    Twist,
    TwistStamped,
)
from zteleop.nodes.actuator import (
    AT_MOST_EVERY,
    DESCRIBE_EVERY,
    IN_A_ROW,
    PERIOD,
    TELL_EVERY,
    Actuator,
    to_command,
)

NEUTRAL = {0: 1509.6, 1: 1530.0}
FORWARD = Twist.planar(0.5)


def ticks(*data: int) -> Int16MultiArray:
    return Int16MultiArray(MultiArrayLayout.zero(), list(data))


class Chip:
    """A driver that remembers every write."""

    tick_us = 4.08

    def __init__(self) -> None:
        self.writes: list[dict[int, float]] = []
        self.log: list[str] = []

    def start(self, neutral_us: dict[int, float]) -> None:
        self.log.append("start")
        self.writes.append(neutral_us)

    def write(self, pulse_us: dict[int, float]) -> None:
        self.log.append("write")
        self.writes.append(pulse_us)

    def close(self) -> None:
        self.log.append("close")


class Robot:
    """An actuator on a chip, and one operator who can prove what is said."""

    def __init__(self, node: Node, clock: Clock, settings: DriveSettings | None = None) -> None:
        self.node, self.clock, self.chip = node, clock, Chip()
        self.actuator = Actuator(node, settings or DriveSettings(), self.chip)
        self.actuator.run()
        self.prover = Prover(7)
        self.chip.writes.clear()

    @property
    def beat(self) -> Beat:
        self.node.timers[TELL_EVERY]()
        return self.node.said["beat"].messages[-1]

    def say(
        self, message: Message, source: str = "keyboard", moving: bool = True, proof: Proof | None = None
    ) -> None:
        self.prover.act(self.beat)
        proof = proof or self.prover.prove(self.beat, moving, self.clock.time)
        key = f"robot/archangel/cmd_vel/{source}"
        self.node.inboxes[f"cmd_vel/{source}"].handler(Received(message, key, proof, self.clock.time))
        self.node.ring(self.clock.time)

    def tick(self, times: int = 1) -> None:
        for _ in range(times):
            self.clock.pass_by(PERIOD)
            self.node.timers[PERIOD]()


@pytest.fixture
def robot(node: Node, clock: Clock) -> Robot:
    return Robot(node, clock)


@pytest.mark.parametrize(
    ("message", "command"),
    [
        (FORWARD, FORWARD),
        (TwistStamped(Header.zero(), FORWARD), FORWARD),
        (Pwm(390, 400), Pwm(390, 400)),
        (ticks(390, 400), Pwm(390, 400)),
        (ticks(390, 400, 99), Pwm(390, 400)),
    ],
)
def test_each_type_of_command_is_a_twist_or_pulses(message: Message, command: Twist | Pwm) -> None:
    assert to_command(message) == command


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (ticks(), r"expected \[steering, throttle\], found \[\]"),
        (ticks(390), r"expected \[steering, throttle\], found \[390\]"),
        (String("go"), "a String commands nothing"),
    ],
)
def test_what_commands_nothing_is_refused_in_words(message: Message, words: str) -> None:
    with pytest.raises(MessageError, match=words):
        to_command(message)


def test_it_hears_every_source_it_knows_by_name_and_no_other(node: Node, clock: Clock) -> None:
    Robot(node, clock, DriveSettings(sources={"nav": Source(10)}))
    assert set(node.inboxes) == {f"{t}/{s}" for t in ("cmd_vel", "pwm") for s in (*SOURCES, "nav")}
    assert node.infos == ["obeys archangel"]


def test_the_chip_starts_at_neutral_and_is_left_at_neutral(node: Node, clock: Clock) -> None:
    chip = Chip()
    actuator = Actuator(node, DriveSettings(), chip)
    assert (chip.log, chip.writes) == (["start"], [NEUTRAL])

    def spin() -> None:
        raise SystemExit(143)

    node.spin = spin
    with pytest.raises(SystemExit):
        actuator.run()
    assert chip.log == ["start", "write", "close"]
    assert chip.writes[-1] == NEUTRAL


def test_a_chip_that_fails_ends_it_in_words(node: Node, clock: Clock) -> None:
    chip = Chip()
    actuator = Actuator(node, DriveSettings(), chip)

    def fail(pulse_us: dict[int, float]) -> None:
        raise DeviceError("the chip does not answer")

    chip.write = fail
    node.spin = lambda: node.timers[PERIOD]()
    with pytest.raises(DeviceError, match="does not answer"):
        actuator.run()


def test_it_steps_and_tells_on_a_clock(robot: Robot) -> None:
    assert set(robot.node.timers) == {PERIOD, TELL_EVERY, DESCRIBE_EVERY}
    robot.tick()
    assert robot.chip.writes == [NEUTRAL]
    robot.node.timers[DESCRIBE_EVERY]()
    assert robot.node.said["vehicle"].messages[-1].kind == "ackermann"
    assert robot.beat.time == robot.clock.time


def test_a_command_is_obeyed_on_arrival_even_right_after_a_step_of_the_clock(robot: Robot) -> None:
    robot.tick()
    robot.say(Pwm(390, 370))
    assert robot.chip.writes[-1][1] == pytest.approx(390 * 4.08)
    assert robot.node.said["drive_status"].messages[-1].state == "driving"
    assert robot.node.infos[-1] == "driving: keyboard drives"


def test_a_few_commands_in_a_row_are_answered_at_once_and_then_share_a_step(robot: Robot) -> None:
    robot.tick()
    writes = len(robot.chip.writes)
    for number in range(IN_A_ROW):
        robot.say(Pwm(380 + number, 370))
    assert len(robot.chip.writes) == writes + IN_A_ROW
    for ticks_ in (395, 400):
        robot.say(Pwm(ticks_, 370))
    assert len(robot.chip.writes) == writes + IN_A_ROW
    (soon,) = robot.node.alarms
    assert soon.due == pytest.approx(robot.clock.time + AT_MOST_EVERY, abs=1e-9)
    robot.clock.time = soon.due
    robot.node.ring(soon.due)
    assert len(robot.chip.writes) == writes + IN_A_ROW + 1
    assert robot.chip.writes[-1][1] == pytest.approx(400 * 4.08)


def test_a_flood_is_answered_at_most_200_times_a_second(robot: Robot) -> None:
    robot.tick()
    robot.chip.writes.clear()
    for number in range(1000):
        robot.say(Pwm(380 + number % 20, 370))
        robot.clock.pass_by(0.0001)
    assert 0.1 / AT_MOST_EVERY - 1 <= len(robot.chip.writes) <= 0.1 / AT_MOST_EVERY + IN_A_ROW


def test_silence_is_heard_by_the_clock(robot: Robot) -> None:
    robot.clock.pass_by(2 * AT_MOST_EVERY)
    robot.say(Pwm(390, 370))
    robot.tick(20)
    assert robot.chip.writes[-1] == NEUTRAL
    assert robot.node.said["drive_status"].messages[-1].state == "link lost"


def test_a_change_of_state_is_told_once(robot: Robot) -> None:
    statuses = robot.node.said["drive_status"]
    robot.tick(5)
    assert statuses.take() == []
    robot.say(Pwm(390, 370))
    assert [status.state for status in statuses.take()] == ["idle", "idle", "driving"]  # two with beats
    robot.tick(5)
    assert statuses.take() == []


def test_what_commands_nothing_is_dropped_and_said(robot: Robot) -> None:
    robot.say(ticks(390))
    assert robot.node.warnings == [
        "robot/archangel/cmd_vel/keyboard: dropped: expected [steering, throttle], found [390]"
    ]
    robot.tick()
    assert robot.chip.writes == [NEUTRAL]


def test_a_refused_command_is_said_with_its_reason(robot: Robot) -> None:
    robot.clock.pass_by(2 * AT_MOST_EVERY)
    robot.say(FORWARD, proof=Proof(1, 1, 0, 0.0, 0.0, 0.0))
    assert robot.node.warnings == [
        "robot/archangel/cmd_vel/keyboard is refused: it was made before the robot's last start"
    ]
    assert robot.chip.writes == []
    assert robot.node.alarms[0].due == float("inf")


def test_after_a_pause_of_its_own_it_begins_a_new_epoch(robot: Robot) -> None:
    robot.clock.pass_by(2 * AT_MOST_EVERY)
    robot.say(FORWARD)
    before = robot.beat.epoch
    robot.clock.pass_by(0.25)
    robot.say(FORWARD, proof=robot.prover.prove(Beat(before, robot.clock.time), True, robot.clock.time))
    assert robot.beat.epoch != before
    assert "this process was stopped for a while" in robot.node.warnings[0]
    robot.tick()
    assert robot.chip.writes[-1] == NEUTRAL


def test_a_step_that_is_a_little_late_is_no_pause(robot: Robot) -> None:
    before = robot.beat.epoch
    robot.clock.pass_by(0.19)
    robot.node.timers[PERIOD]()
    assert robot.beat.epoch == before


def test_every_start_is_an_epoch_that_any_reader_of_json_can_count(robot: Robot, clock: Clock) -> None:
    other = Robot(Node(), clock)
    assert robot.beat.epoch != other.beat.epoch
    assert 0 <= robot.beat.epoch < 2**53
