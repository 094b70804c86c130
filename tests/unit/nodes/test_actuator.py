from collections.abc import Mapping
from pathlib import Path

import pytest
from unit.nodes.fakes import LimitsShelf, Shelf

from zteleop.bus.subscription import Received
from zteleop.bus.topics import TOPICS
from zteleop.control.deadlines import SILENCE, STEADY_EVERY, STEP_EVERY, WATCHDOG_SILENCE
from zteleop.control.mux import Source
from zteleop.control.proof import Proof, Prover
from zteleop.control.settings import SOURCES, DriveSettings
from zteleop.control.standing import NOBODY, Standing
from zteleop.errors import DeviceError
from zteleop.machine.health import LOOK_EVERY, Health
from zteleop.machine.link import UNWATCHED, Report, Words
from zteleop.messages import Beat, DriveStatus, Int16MultiArray, Message, MultiArrayLayout, Pwm, Stop, Twist
from zteleop.nodes.actuator import (
    A_MOMENT,
    AT_MOST_EVERY,
    CHECK_EVERY,
    FORGOT,
    IN_A_ROW,
    KEEP_EVERY,
    Actuator,
)
from zteleop.nodes.output import FAILED_STEPS, REPAIR_EVERY
from zteleop.nodes.watched import UnwatchedError
from zteleop.testing import Clock, FakeNode, MemoryChip

NEUTRAL = {0: 1509.6, 1: 1530.0}
FORWARD = Twist.planar(0.5)
PUSH = Pwm(390, 370)
AT_THE_DOOR = 0.0001
"""s in which a command is passed on"""
"""On the chip at once: nothing limits how fast one steers."""
KEPT = Stop(engaged=True, id=5, by="ann", why="a child on the track")


def ticks(*data: int) -> Int16MultiArray:
    return Int16MultiArray(MultiArrayLayout.zero(), list(data))


class Link:
    """The watchdog at the other end: what it says, and whether it is still there."""

    def __init__(self) -> None:
        self.words: Words | None = Words(None)
        self.reports: list[Report] = []
        self.closed = False

    def close(self) -> None:
        self.closed = True

    def fileno(self) -> int:
        return 9

    def read(self) -> Words:
        if self.words is None:
            raise DeviceError("the watchdog is gone")
        words, self.words = self.words, Words(None)
        return words

    def report(self, report: Report) -> None:
        self.reports.append(report)


class Journal:
    def __init__(self) -> None:
        self.commands: list[tuple[object, ...]] = []
        self.events: list[tuple[str, dict[str, object]]] = []
        self.closed = False

    def command(self, *told: object) -> None:
        self.commands.append(told)

    def event(self, event: str, **values: object) -> None:
        self.events.append((event, values))

    def close(self) -> None:
        self.closed = True


class Robot:
    """An actuator on a chip, a watchdog that hears it, and one operator who can prove what is said."""

    def __init__(
        self,
        node: FakeNode,
        clock: Clock,
        settings: DriveSettings | None = None,
        *,
        chip: MemoryChip | None = None,
        shelf: Shelf | None = None,
        hears: bool = True,
        health: Health | None = None,
        standing: Standing | None = None,
    ) -> None:
        self.node, self.clock = node, clock
        self.chip, self.link = chip or MemoryChip(), Link()
        self.shelf, self.journal = shelf or Shelf(), Journal()
        self.actuator = Actuator(
            node,
            settings or DriveSettings(),
            self.chip,
            self.link,
            self.shelf,
            LimitsShelf(),
            self.journal,
            health,
            standing,
        )
        self.actuator.run()
        self.prover = Prover(7)
        self.tick()
        self.hear(Words(hears))
        self.tick()
        self.chip.writes.clear()
        self.node.said["drive_status"].take()

    @property
    def beat(self) -> Beat:
        self.node.loop.run(TOPICS["beat"].every)
        return self.node.said["beat"].messages[-1]

    @property
    def status(self) -> DriveStatus:
        """What it says five times a second, whatever happens."""
        self.actuator._state.tell_status(self.actuator._step)
        return self.node.said["drive_status"].messages[-1]

    def hear(self, words: Words | None) -> None:
        """Hear the watchdog; None is its end."""
        self.link.words = words
        self.node.loop.watched[self.link.fileno()]()

    def say(
        self, message: Message, source: str = "keyboard", moving: bool = True, proof: Proof | None = None
    ) -> None:
        self.prover.act(self.beat)
        proof = proof or self.prover.prove(self.beat, moving, self.clock.time)
        key = f"robot/archangel/cmd_vel/{source}"
        came = self.clock.time - AT_THE_DOOR
        self.node.inboxes[f"cmd_vel/{source}"].handler(Received(message, key, proof, self.clock.time, came))
        self.node.loop.ring(self.clock.time)

    def stop(self, stop: Stop) -> None:
        self.node.inboxes["stop"].handler(Received(stop, "robot/archangel/stop", None, self.clock.time))

    def tick(self, times: int = 1, watched: bool = True) -> None:
        for _ in range(times):
            self.clock.pass_by(STEP_EVERY)
            if watched:
                self.hear(Words(None))
            self.node.loop.run(STEP_EVERY)
            self.node.loop.ring(self.clock.time)


@pytest.fixture
def robot(node: FakeNode, clock: Clock) -> Robot:
    return Robot(node, clock)


def test_it_hears_every_source_it_knows_by_name_and_stops(node: FakeNode, clock: Clock) -> None:
    Robot(node, clock, DriveSettings(sources={"nav": Source(10)}))
    commands = {f"{t}/{s}" for t in ("cmd_vel", "pwm") for s in (*SOURCES, "nav")}
    assert set(node.inboxes) == {*commands, "stop"}
    assert node.infos[0] == "archangel obeys; zteleop keyboard drives it"


def test_one_that_starts_stopped_says_first_of_all_that_it_is(node: FakeNode, clock: Clock) -> None:
    Robot(node, clock, shelf=Shelf(Stop(engaged=True, id=3, by="ann@desk", why="a cat")))
    assert node.infos == []
    assert node.warnings[0].startswith("archangel obeys once it is released: stopped by ann@desk: a cat")


def test_the_chip_starts_at_neutral_and_is_left_at_neutral(node: FakeNode, clock: Clock) -> None:
    chip, journal = MemoryChip(), Journal()
    actuator = Actuator(node, DriveSettings(), chip, Link(), Shelf(), LimitsShelf(), journal)
    assert (chip.log, chip.writes) == (["start", "read"], [NEUTRAL])

    def spin() -> None:
        raise SystemExit(143)

    node.spin = spin
    with pytest.raises(SystemExit):
        actuator.run()
    assert chip.log == ["start", "read", "write", "close"]
    assert chip.writes[-1] == NEUTRAL
    assert journal.closed


def test_a_chip_that_takes_no_neutral_at_the_end_is_said_and_all_is_closed(
    node: FakeNode, clock: Clock, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("zteleop.nodes.output.REST_WITHIN", 0.0)
    chip, journal, link = MemoryChip(), Journal(), Link()
    actuator = Actuator(node, DriveSettings(), chip, link, Shelf(), LimitsShelf(), journal)
    chip.broken.add("write")
    with pytest.raises(DeviceError, match="does not take a write"):
        actuator.run()
    assert chip.log[-1] == "close"
    assert journal.closed
    assert link.closed


def test_the_watchdog_is_told_of_an_end_before_anything_of_it_can_take_long(
    node: FakeNode, clock: Clock
) -> None:
    chip, link = MemoryChip(), Link()
    actuator = Actuator(node, DriveSettings(), chip, link, Shelf(), LimitsShelf(), Journal())
    write, told = chip.write, []
    chip.write = lambda *values: told.append(link.closed) or write(*values)
    actuator.run()
    assert told == [True]


def test_it_starts_only_when_the_watchdog_hears_it(node: FakeNode, clock: Clock) -> None:
    robot = Robot(node, clock, hears=None)
    assert (robot.status.state, robot.status.why) == (
        "starting",
        "the watchdog does not hear this robot on the bus",
    )
    robot.say(PUSH)
    robot.tick()
    assert robot.chip.pulses == NEUTRAL
    robot.hear(Words(True))
    robot.tick()
    assert robot.status.state == "idle"


def test_what_was_begun_before_the_watchdog_heard_it_moves_nothing(node: FakeNode, clock: Clock) -> None:
    robot = Robot(node, clock, hears=False)
    robot.say(PUSH)
    robot.hear(Words(True))
    robot.tick()
    robot.say(PUSH)
    robot.tick()
    assert robot.chip.pulses == NEUTRAL


def test_a_watchdog_that_hears_no_longer_brings_rest(robot: Robot) -> None:
    robot.say(PUSH)
    assert robot.chip.pulses != NEUTRAL
    robot.hear(Words(False))
    robot.tick()
    assert (robot.status.state, robot.chip.pulses) == ("link lost", NEUTRAL)


def test_whoever_drove_before_the_watchdog_was_deaf_for_a_moment_drives_on(robot: Robot) -> None:
    robot.say(PUSH)
    robot.hear(Words(False))
    for _ in range(60):
        robot.say(PUSH)
        robot.tick()
        assert robot.chip.pulses == NEUTRAL
    robot.hear(Words(True))
    robot.tick()
    robot.say(PUSH)
    assert robot.chip.pulses != NEUTRAL


def test_whoever_drove_before_it_was_deaf_for_long_begins_anew(robot: Robot) -> None:
    robot.say(PUSH)
    robot.hear(Words(False))
    for _ in range(101):
        robot.say(PUSH)
        robot.tick()
    robot.hear(Words(True))
    for _ in range(10):
        robot.tick()
        robot.say(PUSH)
        assert robot.chip.pulses == NEUTRAL
    robot.say(Pwm(375, 370), moving=False)
    robot.tick()
    robot.say(PUSH)
    assert robot.chip.pulses != NEUTRAL


def test_while_the_esc_arms_it_is_starting(node: FakeNode, clock: Clock) -> None:
    robot = Robot(node, clock, chip=MemoryChip(arming=2.0))
    assert (robot.status.state, robot.status.why) == ("starting", "neutral for 2 s while the ESC arms")
    node.loop.run(TOPICS["why"].every)
    assert not node.said["vehicle"].messages[-1].ready
    robot.tick(97)
    assert robot.status.state == "starting"
    robot.tick(2)
    assert robot.status.state == "idle"
    assert node.said["vehicle"].messages[-1].ready


def test_one_in_anothers_place_goes_on_with_the_next_act_and_arms_nothing(
    node: FakeNode, clock: Clock
) -> None:
    now, prover = clock.time, Prover(7)
    prover.act(Beat(5, now - 3.0, 0.0))
    prover.prove(Beat(5, now - 3.0, 0.0), True, 0.0)
    standing = Standing(
        5, now - 9.0, now - 8.0, now - 8.0, list(SOURCES).index("keyboard"), 7, now - 3.0, now - 1.0
    )
    robot = Robot(node, clock, chip=MemoryChip(arming=2.0), hears=None, standing=standing)
    assert robot.beat.epoch == 5
    assert (robot.status.state, robot.status.why) == (
        "link lost",
        "the watchdog does not hear this robot on the bus",
    )
    robot.hear(Words(True))
    robot.tick()
    assert robot.status.why.endswith("; keyboard 0007 goes on with its next act")
    robot.prover = prover
    for _ in range(3):
        prover.act(robot.beat)
        robot.say(PUSH, proof=prover.prove(robot.beat, True, 0.1))
        robot.tick()
    assert robot.chip.pulses != NEUTRAL
    assert (
        "interruption",
        {"why": "it stood still for a moment, and its actuator was started again"},
    ) in robot.journal.events


def test_one_in_the_place_of_another_that_nobody_drove_lets_the_esc_arm(node: FakeNode, clock: Clock) -> None:
    standing = Standing(5, *[clock.time - 1.0] * 3)
    robot = Robot(node, clock, chip=MemoryChip(arming=2.0), standing=standing)
    assert (robot.status.state, robot.status.why) == ("starting", "neutral for 2 s while the ESC arms")


def test_one_in_anothers_place_whose_chip_was_switched_off_meanwhile_starts_anew(
    node: FakeNode, clock: Clock
) -> None:
    keyboard = list(SOURCES).index("keyboard")
    standing = Standing(5, *[clock.time - 1.0] * 3, keyboard, 7, clock.time - 0.9, clock.time - 0.1)
    chip = MemoryChip(arming=2.0)
    chip.broken.add("check")
    robot = Robot(node, clock, chip=chip, standing=standing)
    assert robot.beat.epoch != 5
    assert (robot.status.state, robot.status.why) == ("starting", "neutral for 2 s while the ESC arms")
    assert robot.journal.events[0] == ("chip", {"says": f"{FORGOT}; whoever drove must let go first"})


def test_one_that_nobody_watches_ends_with_a_code_of_its_own(robot: Robot) -> None:
    with pytest.raises(UnwatchedError) as ended:
        robot.tick(round(WATCHDOG_SILENCE / STEP_EVERY) + 2, watched=False)
    assert ended.value.exit_code == UNWATCHED


def test_a_stop_that_was_kept_holds_from_the_start(node: FakeNode, clock: Clock) -> None:
    robot = Robot(node, clock, shelf=Shelf(KEPT))
    robot.say(PUSH)
    assert (robot.status.state, robot.status.stops) == ("stopped", [KEPT])
    assert "stopped by ann: a child on the track" in robot.status.why
    assert robot.chip.pulses == NEUTRAL


def test_a_stop_is_on_the_chip_before_it_is_on_the_disk(robot: Robot) -> None:
    robot.say(PUSH)
    kept: list[object] = []
    robot.shelf.tend = lambda: kept.append((robot.shelf.promised, dict(robot.chip.pulses)))
    robot.stop(KEPT)
    assert kept == [([KEPT], NEUTRAL)]
    assert (robot.status.state, robot.status.stops) == ("stopped", [KEPT])
    assert robot.journal.events[-1] == ("stop", {"by": "ann", "why": "a child on the track", "id": 5})


def test_only_a_release_that_names_the_stop_frees_the_robot_for_what_begins_then(robot: Robot) -> None:
    robot.say(PUSH)
    robot.stop(KEPT)
    robot.stop(Stop(engaged=False, id=6, by="bob", why=""))
    assert robot.status.stops == robot.shelf.stops == [KEPT]
    robot.stop(Stop(engaged=False, id=5, by="bob", why=""))
    assert (robot.status.state, robot.status.stops, robot.shelf.stops) == ("idle", [], [])
    assert robot.journal.events[-1][0] == "release"
    robot.say(PUSH)
    assert robot.chip.pulses == NEUTRAL
    robot.say(Pwm(375, 370), moving=False)
    robot.tick()
    robot.say(PUSH)
    assert robot.chip.pulses != NEUTRAL


def test_a_stop_whose_file_stays_is_not_released(robot: Robot) -> None:
    robot.stop(KEPT)
    robot.shelf.stuck = True
    robot.stop(Stop(engaged=False, id=5, by="bob", why=""))
    assert robot.status.state == "stopped"


def test_of_two_stops_each_is_kept_until_its_own_release(robot: Robot) -> None:
    bobs = Stop(engaged=True, id=6, by="bob", why="")
    for said in (KEPT, bobs):
        robot.stop(said)
    assert robot.status.stops == robot.shelf.stops == [KEPT, bobs]
    robot.stop(Stop(engaged=False, id=6, by="bob", why=""))
    assert (robot.status.state, robot.shelf.stops) == ("stopped", [KEPT])
    assert "bob" not in robot.status.why
    robot.stop(Stop(engaged=False, id=5, by="ann", why=""))
    assert (robot.status.state, robot.shelf.stops) == ("idle", [])


def test_a_stop_that_cannot_be_kept_is_tried_again_each_second_and_told(robot: Robot) -> None:
    robot.shelf.full = True
    robot.stop(KEPT)
    first = robot.node.said["drive_status"].messages[0]
    assert (first.stops, first.unkept) == ([KEPT], "they are being written")
    assert (robot.status.unkept, robot.shelf.stops) == ("no space left", [])
    robot.shelf.full = False
    robot.node.loop.run(KEEP_EVERY)
    assert (robot.status.unkept, robot.shelf.stops) == ("", [KEPT])


def test_a_stop_is_told_with_what_the_chip_shows(robot: Robot) -> None:
    robot.stop(KEPT)
    assert robot.status.confirmed == "read"
    robot.chip.broken |= {"read", "write", "start", "check"}
    robot.tick(5)
    robot.node.loop.run(CHECK_EVERY)
    assert (robot.status.state, robot.status.confirmed) == ("fault", "")
    robot.hear(Words(True, cut=True))
    robot.node.loop.run(TOPICS["beat"].every)
    assert robot.status.confirmed == "cut"
    robot.hear(Words(None))
    robot.node.loop.run(TOPICS["beat"].every)
    assert robot.status.confirmed == "cut", "it said nothing of it"
    robot.hear(Words(False))
    robot.node.loop.run(TOPICS["beat"].every)
    assert robot.status.confirmed == ""


def test_pulses_that_the_chip_did_not_take_are_not_shown(robot: Robot) -> None:
    robot.say(PUSH)
    shown = robot.status.pulses
    robot.chip.broken |= {"write", "start"}
    robot.stop(KEPT)
    assert (robot.status.pulses, robot.status.confirmed) == (shown, "")


def test_whoever_held_on_through_a_stop_is_told_of_its_release(robot: Robot) -> None:
    robot.say(PUSH)
    robot.stop(KEPT)
    robot.stop(Stop(engaged=False, id=5, by="ann", why=""))
    robot.say(PUSH)
    assert "before the stop was released" in robot.node.warnings[-1]


def test_a_late_repeat_of_a_stop_that_was_released_changes_nothing(robot: Robot) -> None:
    for said in (KEPT, Stop(engaged=False, id=5, by="bob", why=""), KEPT):
        robot.stop(said)
    assert (robot.status.state, robot.shelf.stop) == ("idle", None)


def test_it_obeys_and_keeps_the_watchdogs_stop(robot: Robot) -> None:
    robot.say(PUSH)
    robot.hear(Words(None, stops=(KEPT,)))
    assert (robot.status.state, robot.chip.pulses) == ("stopped", NEUTRAL)
    assert robot.shelf.stop == KEPT


def test_without_a_watchdog_it_ends_in_words(robot: Robot) -> None:
    robot.tick(int(WATCHDOG_SILENCE / STEP_EVERY) - 1, watched=False)
    with pytest.raises(DeviceError, match=r"the watchdog has been silent for 0\.4 s; the robot is at rest"):
        robot.tick(2, watched=False)


def test_the_watchdogs_silence_waits_for_no_step(robot: Robot) -> None:
    robot.tick()
    last = robot.clock.time
    assert last + WATCHDOG_SILENCE in [alarm.due for alarm in robot.node.loop.alarms]


def test_words_that_came_while_it_stood_still_itself_count(robot: Robot) -> None:
    robot.tick()
    robot.clock.pass_by(WATCHDOG_SILENCE + 1.0)
    robot.node.loop.ring(robot.clock.time)
    assert "this process stood still" in robot.node.warnings[-1]
    robot.tick(3)


def test_a_watchdog_that_is_gone_ends_it_at_once(robot: Robot) -> None:
    with pytest.raises(DeviceError, match="the watchdog is gone"):
        robot.hear(None)


def test_it_reports_every_step_to_the_watchdog(robot: Robot) -> None:
    robot.tick()
    robot.say(PUSH)
    first, second = robot.link.reports[-2:]
    assert first.stepped == second.stepped == robot.clock.time
    assert first.standing.epoch == second.standing.epoch == robot.beat.epoch
    assert first.standing.source == NOBODY
    assert (second.standing.sender, second.standing.counted) == (robot.prover.sender, robot.clock.time)
    assert first.standing.since < robot.clock.time


def test_a_chip_that_fails_is_a_fault_until_it_is_repaired_through_neutral(robot: Robot) -> None:
    robot.say(PUSH)
    robot.chip.broken |= {"write", "start"}
    robot.tick(4)
    assert (robot.status.state, robot.status.why) == ("fault", "the chip does not take a start")
    robot.chip.broken.clear()
    robot.tick(round(REPAIR_EVERY / STEP_EVERY) + 1)
    assert (robot.status.state, robot.chip.pulses) == ("idle", NEUTRAL)
    robot.say(PUSH)
    assert robot.chip.pulses == NEUTRAL


def test_a_chip_that_forgot_its_settings_is_noticed_while_writes_succeed(robot: Robot) -> None:
    robot.chip.broken |= {"check", "start"}
    robot.node.loop.run(CHECK_EVERY)
    robot.tick()
    assert robot.status.state == "fault"


def test_a_sender_whose_process_is_gone_lets_go_at_once(robot: Robot) -> None:
    robot.say(PUSH)
    robot.node.membership.leaves(8)
    assert robot.chip.pulses != NEUTRAL
    robot.node.membership.leaves(7)
    robot.node.loop.ring(robot.clock.time)
    assert robot.chip.pulses == NEUTRAL
    assert (robot.status.state, robot.status.why) == (
        "link lost",
        "keyboard 0007 is not heard any more: ended, suspended or cut off; whoever begins drives",
    )


def test_the_journal_hears_every_command_with_its_verdict(robot: Robot) -> None:
    robot.say(PUSH)
    robot.say(PUSH, proof=Proof(1, 1, 0, 0.0, 3.0, 0.0))
    (source, sender, command, acted, refusal, now), refused = robot.journal.commands
    assert (source, sender, command, refusal) == ("keyboard", 7, PUSH, None)
    assert acted == now == robot.clock.time
    assert refused[1] == 1
    assert "before the robot's last start" in refused[4]
    assert ("state", {"state": "driving", "why": "keyboard 0007 drives"}) in robot.journal.events


def test_it_steps_and_tells_on_a_clock(robot: Robot) -> None:
    robot.tick()
    assert robot.chip.writes == [NEUTRAL]
    robot.node.loop.run(TOPICS["why"].every)
    assert robot.node.said["vehicle"].messages[-1].kind == "ackermann"
    assert robot.beat.time == robot.clock.time


def test_a_command_is_obeyed_on_arrival_even_right_after_a_step_of_the_clock(robot: Robot) -> None:
    robot.tick()
    robot.say(PUSH)
    assert robot.chip.writes[-1][1] == pytest.approx(390 * 4.08)
    assert robot.node.said["drive_status"].messages[-1].state == "driving"
    assert robot.node.infos[-1] == "driving: keyboard 0007 drives"


@pytest.fixture
def alive(robot: Robot) -> Robot:
    """A robot whose watchdog speaks while time passes by itself."""
    robot.node.loop.every(STEADY_EVERY, lambda: robot.hear(Words(True)))
    robot.node.live(0.3)
    robot.chip.writes.clear()
    return robot


def test_it_steps_often_only_while_its_pulses_change(alive: Robot) -> None:
    alive.node.live(1.0)
    assert len(alive.chip.writes) == pytest.approx(1.0 / STEADY_EVERY, abs=1)
    alive.say(Twist.planar(2.0))  # which it accelerates to
    alive.chip.writes.clear()
    alive.node.live(0.2)
    assert len(alive.chip.writes) >= 0.2 / STEP_EVERY - 1
    for _ in range(20):
        alive.say(PUSH)
        alive.node.live(STEADY_EVERY)
    alive.chip.writes.clear()
    alive.node.live(0.2)
    assert len(alive.chip.writes) == pytest.approx(0.2 / STEADY_EVERY, abs=1)
    assert alive.chip.pulses != NEUTRAL


def test_what_it_does_is_said_with_each_beat_while_driven_and_else_when_it_is_news(alive: Robot) -> None:
    statuses = alive.node.said["drive_status"]
    statuses.take()
    alive.node.live(2.0)
    assert len(statuses.take()) == pytest.approx(2.0 * 5, abs=1)
    for _ in range(20):
        alive.say(PUSH)
        alive.node.live(TOPICS["beat"].every)
    assert len(statuses.take()) >= 19
    alive.node.live(1.0)
    statuses.take()
    alive.shelf.unkept = "the disk is full"
    alive.node.live(TOPICS["beat"].every)
    assert [status.unkept for status in statuses.take()] == ["the disk is full"], "at once"


def test_a_deadline_is_heard_when_it_passes_and_not_at_the_next_step(alive: Robot) -> None:
    for _ in range(5):
        alive.say(PUSH)
        alive.node.live(STEADY_EVERY)
    alive.say(PUSH)
    alive.node.live(SILENCE)
    assert alive.chip.pulses != NEUTRAL
    alive.node.live(2 * A_MOMENT)
    assert alive.chip.pulses == NEUTRAL


def test_a_chip_that_takes_nothing_is_tried_often(alive: Robot) -> None:
    alive.chip.broken |= {"write", "start"}
    alive.node.live(STEADY_EVERY + FAILED_STEPS * STEP_EVERY)
    assert alive.status.state == "fault"


def test_the_pulses_are_out_before_a_command_is_noted_or_told(robot: Robot) -> None:
    out: list[int] = []
    command, log = robot.journal.command, robot.node.log.info
    robot.journal.command = lambda *about: out.append(len(robot.chip.writes)) or command(*about)
    robot.node.log.info = lambda *about: out.append(len(robot.chip.writes)) or log(*about)
    robot.tick()
    before = len(robot.chip.writes)
    robot.say(PUSH)
    assert out == [before + 1] * 2, "a command, and that it drives"


def test_a_few_commands_in_a_row_are_answered_at_once_and_then_share_a_step(robot: Robot) -> None:
    robot.tick()
    writes = len(robot.chip.writes)
    for number in range(IN_A_ROW):
        robot.say(Pwm(380 + number, 370))
    assert len(robot.chip.writes) == writes + IN_A_ROW
    for ticks_ in (395, 400):
        robot.say(Pwm(ticks_, 370))
    assert len(robot.chip.writes) == writes + IN_A_ROW
    soon = min(robot.node.loop.alarms, key=lambda alarm: alarm.due)
    assert soon.due == pytest.approx(robot.clock.time + AT_MOST_EVERY, abs=1e-9)
    robot.clock.time = soon.due
    robot.node.loop.ring(soon.due)
    assert len(robot.chip.writes) == writes + IN_A_ROW + 1
    assert robot.chip.writes[-1][1] == pytest.approx(400 * 4.08)


def test_what_a_command_took_from_the_door_to_the_chip_is_told_part_by_part(robot: Robot) -> None:
    write = robot.chip.write

    def take_time(pulse_us: Mapping[int, float]) -> None:
        robot.clock.pass_by(0.002)
        write(pulse_us)

    robot.chip.write = take_time
    robot.say(PUSH)
    robot.say(PUSH, moving=False, proof=Proof(9, 1, 9, 0.0, 0.0, 0.0))  # refused: it gets nowhere
    robot.clock.pass_by(1.0)
    robot.node.loop.ring(robot.clock.time)
    (told,) = robot.node.said["latency"].messages
    assert (told.by, [(hop.name, hop.commands) for hop in told.hops]) == (
        "actuator",
        [("door to actuator", 1), ("actuator to chip", 1)],
    )
    assert [hop.median for hop in told.hops] == pytest.approx([AT_THE_DOOR, 0.002])


def test_a_flood_is_answered_at_most_200_times_a_second(robot: Robot) -> None:
    robot.tick()
    robot.chip.writes.clear()
    for number in range(1000):
        robot.say(Pwm(380 + number % 20, 370))
        robot.clock.pass_by(0.0001)
    assert 0.1 / AT_MOST_EVERY - 1 <= len(robot.chip.writes) <= 0.1 / AT_MOST_EVERY + IN_A_ROW


def test_a_crowd_that_leaves_is_answered_at_most_200_times_a_second(robot: Robot) -> None:
    robot.tick()
    robot.chip.writes.clear()
    for number in range(1000):
        robot.node.membership.leaves(1000 + number)
        robot.clock.pass_by(0.0001)
        robot.node.loop.ring(robot.clock.time)
    assert len(robot.chip.writes) <= 0.1 / AT_MOST_EVERY + IN_A_ROW


def test_silence_is_heard_by_the_clock(robot: Robot) -> None:
    robot.clock.pass_by(2 * AT_MOST_EVERY)
    robot.say(PUSH)
    robot.tick(20)
    assert robot.chip.writes[-1] == NEUTRAL
    assert robot.node.said["drive_status"].messages[-1].state == "link lost"


def test_a_change_of_state_is_told_once(robot: Robot) -> None:
    statuses = robot.node.said["drive_status"]
    robot.tick(5)
    assert statuses.take() == []
    robot.say(PUSH)
    assert [status.state for status in statuses.take()] == ["driving"]
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
    words = "the command was made before the robot's last start"
    assert robot.node.warnings == [f"keyboard 0001 is refused: {words}"]
    assert robot.chip.writes == []
    assert robot.node.loop.alarms[0].due == float("inf")


def test_after_a_long_pause_of_its_own_it_begins_a_new_epoch(robot: Robot) -> None:
    robot.clock.pass_by(2 * AT_MOST_EVERY)
    robot.say(FORWARD)
    before = robot.beat.epoch
    robot.clock.pass_by(0.55)
    robot.say(FORWARD, proof=robot.prover.prove(Beat(before, robot.clock.time, 0.0), True, robot.clock.time))
    assert robot.beat.epoch != before
    assert robot.node.warnings[0] == "this process stood still for 0.55 s; whoever drove must let go first"
    robot.tick()
    assert robot.chip.writes[-1] == NEUTRAL


def test_after_a_short_one_whoever_drove_goes_on_with_the_next_act_and_not_before(robot: Robot) -> None:
    robot.clock.pass_by(2 * AT_MOST_EVERY)
    robot.say(PUSH)
    beat = robot.beat
    robot.clock.pass_by(0.25)
    robot.say(PUSH, proof=robot.prover.prove(beat, True, robot.clock.time))
    robot.tick()
    assert robot.chip.pulses == NEUTRAL
    assert robot.beat.epoch == beat.epoch
    assert robot.node.warnings[0] == (
        "this process stood still for 0.25 s; whoever drove goes on with the next act"
    )
    assert robot.status.why.startswith(
        "this process stood still for 0.25 s; keyboard 0007 goes on with its next act"
    )
    assert ("interruption", {"why": "this process stood still for 0.25 s"}) in robot.journal.events
    robot.tick()
    robot.say(PUSH)
    robot.tick()
    assert robot.chip.pulses != NEUTRAL


def test_a_step_that_is_a_little_late_is_no_pause(robot: Robot) -> None:
    before = robot.beat.epoch
    robot.clock.pass_by(0.19)
    robot.node.loop.run(STEP_EVERY)
    assert robot.beat.epoch == before


def test_every_start_is_an_epoch_that_any_reader_of_json_can_count(robot: Robot, clock: Clock) -> None:
    other = Robot(FakeNode(), clock)
    assert robot.beat.epoch != other.beat.epoch
    assert 0 <= robot.beat.epoch < 2**53


def test_a_weak_supply_slows_it_down_and_is_told(node: FakeNode, clock: Clock, tmp_path: Path) -> None:
    volt = tmp_path / "class/hwmon/hwmon0"
    volt.mkdir(parents=True)
    (volt / "name").write_text("rpi_volt\n")
    (volt / "in0_lcrit_alarm").write_text("0\n")
    robot = Robot(node, clock, health=Health(tmp_path, node.log))
    node.loop.run(LOOK_EVERY)
    assert (robot.status.max_speed, robot.status.slowed) == (3.0, "")
    (volt / "in0_lcrit_alarm").write_text("1\n")
    node.loop.run(LOOK_EVERY)
    robot.tick()
    assert robot.status.max_speed == 1.5
    assert "undervoltage" in robot.status.slowed
    assert any("undervoltage" in words for words in node.warnings)
    node.loop.run(TOPICS["why"].every)
    caps = [layer.says for layer in node.said["why"].messages[-1].layers if layer.name == "cap"]
    assert caps == ["1.5 of 3 m/s: the Pi's supply is too low (undervoltage); use a better one"]


def refuse(robot: Robot, times: int) -> None:
    for number in range(times):
        robot.tick(5)
        robot.say(FORWARD, proof=Proof(255, number + 1, 0, 0.0, 0.0, 0.0))
        robot.node.loop.run(TOPICS["why"].every)


def test_whoever_is_refused_for_a_while_is_told_and_nobody_else(robot: Robot) -> None:
    told = robot.node.said["refusals"]
    robot.say(PUSH)
    robot.node.loop.run(TOPICS["why"].every)
    refuse(robot, 5)
    assert told.messages == []
    refuse(robot, 3)
    refused = told.take()[-1].refused[0]
    assert (refused.sender, refused.source) == ("ff", "keyboard")
    assert refused.why == "the command was made before the robot's last start"
    assert refused.since > 0.5
    robot.tick(110)
    told.take()
    robot.node.loop.run(TOPICS["why"].every)
    assert told.take() == []


def drive_once(robot: Robot, prover: Prover, source: str) -> None:
    """Say a command, and let the robot tell whom it does not obey."""
    robot.tick(5)
    prover.act(robot.beat)
    robot.say(PUSH, source=source, proof=prover.prove(robot.beat, True, robot.clock.time))
    robot.tick()
    robot.node.loop.run(TOPICS["why"].every)


def drive(robot: Robot, prover: Prover, source: str) -> None:
    for _ in range(10):
        drive_once(robot, prover, source)


def test_whoever_idles_as_the_robot_does_is_no_news(robot: Robot) -> None:
    robot.say(PUSH)
    acted = robot.beat
    for tenths in range(60):
        robot.tick(5)
        proof = robot.prover.prove(robot.beat, True, robot.clock.time)
        if tenths in (52, 58):  # a tenth of a second, and more than half a second, after the deadline
            robot.node.warnings.clear()
        robot.node.inboxes["cmd_vel/keyboard"].handler(
            Received(PUSH, "robot/archangel/cmd_vel/keyboard", proof, robot.clock.time)
        )
        if tenths == 52:
            assert robot.node.warnings == []
    assert acted
    assert "its operator has not acted for too long" in robot.node.warnings[0]


def test_whoever_waits_for_another_source_is_told_and_when_it_is_obeyed_again(robot: Robot) -> None:
    told = robot.node.said["refusals"]
    program, keyboard = Prover(0xFF), Prover(0xAA)
    drive(robot, program, "program")
    assert told.take() == []
    for _ in range(10):
        drive_once(robot, program, "program")
        drive_once(robot, keyboard, "keyboard")
    (refused,) = told.take()[-1].refused
    assert (refused.sender, refused.why) == (
        "ff",
        "keyboard 00aa drives, with priority 90 over 50; this one is obeyed when that one is done",
    )
    drive(robot, program, "program")
    assert told.take()[-1].refused == []


def test_whoever_drives_is_told_in_the_log_when_it_is_another(robot: Robot) -> None:
    drive_once(robot, Prover(0xFF), "program")
    drive_once(robot, Prover(0xAA), "keyboard")
    assert robot.node.infos[-2:] == ["driving: program 00ff drives", "driving: keyboard 00aa drives"]


def test_what_they_were_refused_for_is_told_to_nobody_once_it_is_over(node: FakeNode, clock: Clock) -> None:
    robot = Robot(node, clock, shelf=Shelf(KEPT))
    for _ in range(8):
        drive_once(robot, robot.prover, "keyboard")
    assert node.said["refusals"].take()[-1].refused[0].why.startswith("the robot is kept at rest")
    release = Stop(engaged=False, id=KEPT.id, by="ann", why="")
    node.inboxes["stop"].handler(Received(release, "stop", None, clock.time))
    node.loop.run(TOPICS["why"].every)
    assert node.said["refusals"].take() == []
    drive_once(robot, robot.prover, "keyboard")
    assert (
        node.said["refusals"]
        .take()[-1]
        .refused[0]
        .why.startswith("it was moving before the stop was released")
    )


def test_who_is_refused_hears_what_keeps_the_robot_at_rest_and_which_stop_was_the_last(
    node: FakeNode, clock: Clock
) -> None:
    shelf = Shelf(KEPT)
    shelf.past = 3
    robot = Robot(node, clock, shelf=shelf)
    refuse(robot, 8)
    told = node.said["refusals"].messages[-1]
    assert (told.rest, told.released) == (robot.status.why.partition("; keyboard")[0], 3)
    robot.node.inboxes["stop"].handler(
        Received(Stop(engaged=False, id=KEPT.id, by="ann", why=""), "stop", None, clock.time)
    )
    assert robot.status.released == KEPT.id


def test_whoever_drives_is_told_how_fast_he_may_as_it_is_now(robot: Robot) -> None:
    fastest = robot.node.said["vehicle"].messages[-1].max_speed
    robot.node.parameters["limits.speed"].set(0.5)
    robot.node.loop.run(TOPICS["why"].every)
    told = robot.node.said["vehicle"].messages[-1]
    assert (told.max_speed, told.allowed_speed) == (fastest, 0.5)


def test_whoever_drives_is_told_how_often_to_act_as_it_is_now(robot: Robot) -> None:
    assert robot.node.said["vehicle"].messages[-1].operator_silence == 5.0
    robot.node.parameters["deadlines.operator"].set(2.0)
    robot.node.loop.run(TOPICS["why"].every)
    assert robot.node.said["vehicle"].messages[-1].operator_silence == 2.0
