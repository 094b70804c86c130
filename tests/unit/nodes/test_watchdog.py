import signal
from collections.abc import Iterable
from itertools import pairwise
from types import SimpleNamespace

import pytest
from unit.nodes.fakes import Shelf

from zteleop.bus.lane.wire import Answered, Asked
from zteleop.bus.subscription import Received
from zteleop.bus.topics import TOPICS
from zteleop.control.deadlines import (
    ACTUATOR_SILENCE,
    ACTUATOR_START,
    BLIND,
    GRACE,
    LATE_STEP,
    STEADY_EVERY,
    STEP_EVERY,
)
from zteleop.control.patience import AT_MOST
from zteleop.control.proof import Prover
from zteleop.control.settings import DriveSettings
from zteleop.control.standing import Standing
from zteleop.errors import DeviceError
from zteleop.machine import systemd
from zteleop.machine.link import CUT, HEARS, HEARS_NOT, UNWATCHED, Report
from zteleop.messages import Beat, Message, Pwm, Stop, WatchdogStatus
from zteleop.nodes import watchdog as module
from zteleop.nodes.hand import MISSES, YIELD
from zteleop.nodes.watchdog import ENDS_WITHIN, LOOK_EVERY, RESTS_WITHIN, Watchdog
from zteleop.testing import Clock, FakeNode, MemoryChip

NEUTRAL = {0: 1509.6, 1: 1530.0}
MOVING = {0: 1600.0, 1: 1530.0}
PUSH = Pwm(390, 370)
PAUSE = 0.1
FILE = 9
EPOCH = 1


def turn_deaf(hand: MemoryChip) -> None:
    """Let a chip that moves take nothing more."""
    hand.pulses = dict(MOVING)
    hand.broken |= {"write", "start"}


class Child:
    """An actuator that reports a step every 20 ms while it lives and is not frozen."""

    def __init__(self, clock: Clock, hand: MemoryChip) -> None:
        self.clock, self.hand = clock, hand
        self.starts, self.started = 0, float("-inf")
        self.newest: Report | None = None
        self.stopped_since: float | None = None
        self.link: SimpleNamespace | None = None
        self.words: list[bytes] = []
        self.stops: list[Stop] = []
        self.alive = self.dead = self.frozen = False
        self.moves = False
        """It writes motion, whatever anybody says."""
        self.stuck = False
        """It cannot be killed: its write is stuck in the kernel."""
        self.hangs = False
        """It does not end when it is asked to."""
        self.beats = True
        """Its beats arrive on the bus."""
        self.obeys = True
        """It rests for a stop that it was told of."""
        self.standing = Standing(EPOCH, 999.0, 999.0, 999.0)
        self.followed: list[Standing | None] = []
        """In whose place each of them was started."""
        self.code: int | None = None
        self.log: list[str] = []

    @property
    def ready(self) -> bool:
        return self.newest is not None

    @property
    def gone(self) -> bool:
        return not self.alive

    def fileno(self) -> int:
        return FILE

    def start(self, now: float, standing: Standing | None = None) -> None:
        self.followed.append(standing)
        self.starts, self.started, self.newest = self.starts + 1, now, None
        self.stopped_since = None
        self.alive, self.dead = True, False
        self.link = SimpleNamespace(fileno=lambda: FILE, send=self.words.append, stop=self.stops.append)
        self.log.append("start")

    def hear(self, now: float) -> None:
        if self.dead:
            raise EOFError
        if not self.frozen:
            stopped = self.obeys and bool(self.stops)
            self.newest = Report(now, self.standing, stopped)
            self.stopped_since = (self.stopped_since or now) if stopped else None

    def silence(self, now: float) -> float:
        last = self.newest.stepped if self.newest else self.started
        return now - (last if last <= now else self.started)

    def ask_to_end(self) -> None:
        self.log.append("ask")
        self.alive = self.alive and self.hangs

    def end(self, patience: float) -> int | None:
        self.log.append(f"end {patience:g}")
        self.alive, self.link = self.stuck, None
        return None if self.stuck else self.code

    def pause(self, now: float) -> float:
        return PAUSE


class Lane:
    """Datagrams that ask for a stop, and what was answered."""

    def __init__(self) -> None:
        self.waiting: list[SimpleNamespace] = []
        self.answers: list[Answered] = []

    def ask(self, stop: Stop) -> None:
        asked = Asked("archangel", stop.id, stop.by, stop.why)
        self.waiting.append(SimpleNamespace(asked=asked, answer=self.answers.append))

    def take(self, now: float) -> list[SimpleNamespace]:
        taken, self.waiting = self.waiting, []
        return taken


class Kennel:
    """A watchdog, what it watches, and the time."""

    def __init__(self, node: FakeNode, clock: Clock) -> None:
        self.node, self.clock = node, clock
        self.hand, self.shelf = MemoryChip(), Shelf()
        self.hand.pulses = dict(NEUTRAL)
        self.child = Child(clock, self.hand)
        self.enabled: list[bool] = []
        self.has_pin = True
        self.lane = Lane()
        self.dog = Watchdog(
            node, DriveSettings(), self.hand, self.child, self.shelf, self.enable, lane=self.lane
        )
        self.prover = Prover(7)

    def enable(self, on: bool) -> bool:
        self.enabled.append(on)
        return self.has_pin

    def wake(self) -> None:
        """Start, and live until the actuator steps."""
        self.dog.run()
        self.live(1.0)
        self.hand.log.clear()

    def live(self, seconds: float) -> None:
        """Let the actuator report, and the watchdog do all that is due."""
        for _ in range(round(seconds / STEP_EVERY)):
            if self.child.alive and self.child.dead:
                self.hear_actuator()
            if self.child.alive and not self.child.frozen and self.child.beats:
                self.node.inboxes["beat"].waiting.clear()  # its ring holds one
                self.hear("beat", Beat(EPOCH, self.clock.time, 0.0))
            if self.child.alive and self.child.moves:
                self.hand.pulses = dict(MOVING)
            self.node.live(STEP_EVERY)

    def hear_actuator(self) -> None:
        if FILE in self.node.loop.watched:
            self.node.loop.watched[FILE]()

    def hear(self, topic: str, message: Message) -> None:
        """Hear a message; a command is one that moves, by somebody who acts."""
        proof = None
        if topic.startswith("pwm"):
            beat = Beat(EPOCH, self.clock.time, 0.0)
            self.prover.act(beat)
            proof = self.prover.prove(beat, True, self.clock.time)
        key = f"robot/archangel/{topic}"
        self.node.inboxes[topic].waiting.append(Received(message, key, proof, self.clock.time))

    def until(self, condition: object, patience: float = 10.0) -> float:
        """Live until something is so; return after how long."""
        began = self.clock.time
        while not condition():
            assert self.clock.time < began + patience, "it never came"
            self.live(STEP_EVERY)
        return self.clock.time - began

    @property
    def restarted(self) -> bool:
        return self.child.starts == 2

    @property
    def resting(self) -> bool:
        return any("is gone" in error for error in self.node.errors)

    @property
    def status(self) -> WatchdogStatus:
        self.node.loop.run(TOPICS["watchdog"].every)
        return self.node.said["watchdog"].messages[-1]


@pytest.fixture
def told(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What systemd is told."""
    told: list[str] = []
    monkeypatch.setattr(systemd, "notify", told.append)
    return told


@pytest.fixture
def handlers(monkeypatch: pytest.MonkeyPatch) -> dict[int, object]:
    handlers: dict[int, object] = {}
    monkeypatch.setattr(signal, "signal", handlers.__setitem__)
    return handlers


@pytest.fixture
def kennel(
    node: FakeNode,
    clock: Clock,
    told: list[str],
    handlers: dict[int, object],
    monkeypatch: pytest.MonkeyPatch,
) -> Kennel:
    monkeypatch.setattr(module, "time", SimpleNamespace(sleep=clock.pass_by))
    return Kennel(node, clock)


@pytest.fixture
def awake(kennel: Kennel, monkeypatch: pytest.MonkeyPatch) -> Kennel:
    """A watchdog at work, whose end is another test's subject."""
    with monkeypatch.context() as patch:
        patch.setattr(Watchdog, "_finish", lambda dog: None)
        kennel.wake()
    return kennel


def test_it_starts_the_actuator_and_lets_the_outputs_through_once_that_steps(
    awake: Kennel, told: list[str]
) -> None:
    assert (awake.child.starts, awake.enabled) == (1, [True])
    assert told.count("READY=1") == 1
    silence = awake.status.silence
    assert awake.status == WatchdogStatus("watching", "the actuator steps", silence, False, False, 0, 0)
    assert 0.0 <= silence <= STEADY_EVERY


def test_it_says_20_times_a_second_that_it_watches_and_hears(awake: Kennel, told: list[str]) -> None:
    awake.child.words.clear()
    told.clear()
    awake.live(1.0)
    assert len(awake.child.words) == pytest.approx(20, abs=1)
    assert set(awake.child.words) == {HEARS}
    assert len(told) == pytest.approx(20, abs=1)


def test_one_that_is_late_all_the_time_hears_silence_all_the_same(awake: Kennel) -> None:
    awake.hand.pulses = dict(MOVING)
    awake.child.frozen = True
    began = awake.clock.time
    while not awake.resting and awake.clock.time < began + 5.0:
        awake.clock.pass_by(LATE_STEP + 0.01)
        awake.node.live(2 * STEP_EVERY)
    assert awake.clock.time - began <= 2 * ACTUATOR_SILENCE + LATE_STEP
    assert awake.hand.pulses == NEUTRAL


def test_it_says_when_it_does_not_hear_the_actuator_on_the_bus(awake: Kennel) -> None:
    awake.live(0.1)
    awake.child.beats = False
    awake.live(0.7)
    assert awake.child.words[-1] == HEARS_NOT


def test_an_actuator_that_is_well_is_left_alone(awake: Kennel) -> None:
    awake.live(20.0)
    assert (awake.child.starts, awake.node.errors, awake.shelf.stop) == (1, [], None)
    assert set(awake.hand.log) == {"read"}


def test_a_silent_actuator_is_killed_after_a_quarter_of_a_second(awake: Kennel) -> None:
    awake.hand.pulses = dict(MOVING)
    awake.hear("pwm/keyboard", PUSH)
    awake.child.frozen = True
    seconds = awake.until(lambda: awake.resting)
    assert seconds == pytest.approx(ACTUATOR_SILENCE, abs=2 * STEP_EVERY)
    assert awake.child.log[-1] == "end 0"
    assert awake.hand.pulses == NEUTRAL
    assert "it was silent for 0.2" in awake.node.errors[-1]


def test_a_starting_actuator_has_five_seconds_and_the_next_twice_as_long(
    kennel: Kennel, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where a start takes six, each would be killed just before it is over, for ever."""
    monkeypatch.setattr(Watchdog, "_finish", lambda dog: None)
    kennel.child.frozen = True
    kennel.dog.run()
    for number, seconds in enumerate((ACTUATOR_START, 2 * ACTUATOR_START, 4 * ACTUATOR_START), 1):
        errors = len(kennel.node.errors)
        took = kennel.until(lambda: len(kennel.node.errors) > errors, 5 * ACTUATOR_START)  # noqa: B023
        assert took == pytest.approx(seconds, abs=3 * STEP_EVERY)
        words = f"it did not step within {seconds:g} s of its start, and the next has {2 * seconds:g} s"
        assert words in kennel.node.errors[-1]
        kennel.until(lambda: kennel.child.starts > number)  # noqa: B023
    kennel.child.frozen = False
    kennel.live(1.0)
    kennel.child.frozen = True
    kennel.until(lambda: kennel.child.starts > 4)
    errors = len(kennel.node.errors)
    took = kennel.until(lambda: len(kennel.node.errors) > errors)
    assert took == pytest.approx(ACTUATOR_START, abs=3 * STEP_EVERY), (
        "one that stepped has proved the machine fast"
    )


def test_an_actuator_that_ends_is_noticed_at_once_and_neutral_comes_first(awake: Kennel) -> None:
    awake.hand.pulses = dict(MOVING)
    awake.child.dead = True
    pulses_at_the_wait: list[object] = []
    end = awake.child.end
    awake.child.end = lambda patience: pulses_at_the_wait.append(dict(awake.hand.pulses)) or end(patience)
    awake.hear_actuator()
    assert pulses_at_the_wait == [NEUTRAL]
    assert awake.child.log[-1] == f"end {GRACE:g}"
    assert awake.node.errors == [
        "the actuator is gone: it ended; the chip is kept at rest and another starts"
    ]
    assert FILE not in awake.node.loop.watched


def test_after_a_pause_of_its_own_it_listens_before_it_judges(awake: Kennel) -> None:
    """Both were stopped; the actuator must not be killed for a silence that nobody could hear."""
    awake.clock.pass_by(3.0)
    awake.node.live(0.1)
    assert not awake.resting
    awake.live(1.0)
    assert awake.child.starts == 1


def test_after_a_pause_of_its_own_a_dead_actuator_is_still_found(awake: Kennel) -> None:
    awake.child.frozen = True
    awake.clock.pass_by(3.0)
    assert awake.until(lambda: awake.resting) == pytest.approx(ACTUATOR_SILENCE, abs=3 * STEP_EVERY)


def test_pulses_that_somebody_may_drive_are_left_alone(awake: Kennel) -> None:
    awake.hand.pulses = dict(MOVING)
    for _ in range(200):
        awake.hear("pwm/keyboard", PUSH)
        awake.live(STEP_EVERY)
    assert awake.shelf.stop is None
    status = awake.status
    assert (status.moving, status.allowed, status.commands) == (True, True, 200)


def test_pulses_that_nobody_may_drive_are_stopped_and_the_actuator_told(awake: Kennel) -> None:
    awake.hand.pulses = dict(MOVING)
    seconds = awake.until(lambda: awake.shelf.stop)
    assert seconds <= 3 * LOOK_EVERY
    assert awake.shelf.stop.by == "the watchdog"
    assert awake.shelf.stop.why.startswith("its pulses moved although ")
    assert awake.child.stops == [awake.shelf.stop]
    assert awake.hand.pulses == NEUTRAL
    assert awake.child.starts == 1
    assert awake.node.errors[0].startswith("stops the robot: its pulses moved although ")


def test_one_that_moves_on_although_the_watchdog_stopped_it_is_killed(awake: Kennel) -> None:
    awake.child.moves = True
    awake.until(lambda: awake.shelf.stop)
    assert awake.until(lambda: awake.resting) <= 4 * LOOK_EVERY
    assert awake.hand.pulses == NEUTRAL


def test_one_that_moves_on_although_somebody_stopped_it_is_killed(awake: Kennel) -> None:
    def push() -> bool:
        awake.hear("pwm/keyboard", PUSH)
        return awake.resting

    awake.child.moves = True
    awake.until(lambda: push() or awake.clock.time > 1010.0)
    assert not awake.resting
    awake.shelf.add(Stop(engaged=True, id=5, by="ann", why=""))
    seconds = awake.until(push)
    assert GRACE < seconds <= GRACE + 4 * LOOK_EVERY
    assert "its pulses moved although a stop is in force" in awake.node.errors[-1]
    assert awake.hand.pulses == NEUTRAL


def test_a_stop_that_no_disk_keeps_is_told_to_every_actuator_that_starts(awake: Kennel) -> None:
    awake.shelf.full = True
    stop = Stop(engaged=True, id=5, by="ann", why="")
    awake.hear("stop", stop)
    awake.live(1.0)
    assert awake.child.stops == [stop]
    awake.child.dead = True
    awake.until(lambda: awake.resting)
    awake.until(lambda: awake.restarted and awake.child.stops == [stop, stop])
    awake.hear("stop", Stop(engaged=False, id=5, by="ann", why=""))
    awake.child.dead = True
    awake.until(lambda: awake.resting)
    awake.until(lambda: awake.restarted)
    awake.live(0.5)
    assert awake.child.stops == [stop, stop]


def test_a_stop_that_the_actuator_ignores_is_engaged(awake: Kennel) -> None:
    stop = Stop(engaged=True, id=5, by="ann", why="")
    awake.hear("stop", stop)
    assert awake.until(lambda: awake.shelf.stop) <= GRACE + 2 * STEADY_EVERY
    assert awake.shelf.stop == stop
    assert awake.node.errors == ["stops the robot: ann"]
    assert awake.child.stops == [stop]


def test_a_chip_that_cannot_be_read_is_said_and_nobody_is_killed_for_it(awake: Kennel) -> None:
    awake.hand.broken.add("read")
    awake.live(1.0)
    assert "cannot read the chip: the chip does not take a read" in awake.node.warnings
    assert awake.child.starts == 1


def take_long(awake: Kennel, seconds: float) -> None:
    read = awake.hand.read

    def slowly(channels: Iterable[int]) -> dict[int, float | None]:
        awake.clock.time += seconds
        return read(channels)

    awake.hand.read = slowly


def test_a_chip_that_cannot_be_read_for_a_while_is_cut_off_until_it_can(awake: Kennel) -> None:
    """Nobody can say what it puts out, nor change it; the actuator is told, as a stop is confirmed by it."""
    awake.hand.broken.add("read")
    awake.live(BLIND)
    assert awake.enabled == [True]
    awake.child.words.clear()
    awake.live(0.2)
    assert awake.enabled == [True, False]
    assert awake.child.words[-1] == CUT[HEARS]
    assert [error for error in awake.node.errors if "its outputs are cut" in error]
    awake.hand.broken.clear()
    awake.hand.pulses = dict(NEUTRAL)
    awake.live(0.2)
    assert awake.enabled == [True, False, True]
    assert awake.child.words[-1] == HEARS
    assert awake.child.starts == 1


def test_a_chip_on_a_bus_that_hangs_is_cut_off_as_well(awake: Kennel) -> None:
    take_long(awake, 0.06)  # what three attempts of 20 ms come to
    awake.hand.broken.add("read")
    began = awake.clock.time
    awake.until(lambda: awake.enabled[-1] is False)
    assert awake.clock.time - began <= 0.5


def test_one_look_that_fails_cuts_nothing_however_long_it_took(awake: Kennel) -> None:
    take_long(awake, 0.5)
    awake.hand.broken.add("read")
    awake.live(STEP_EVERY * 5)
    assert awake.dog._hand._missed == 1
    assert awake.enabled == [True]


def test_a_moment_without_a_look_cuts_nothing(awake: Kennel) -> None:
    for _ in range(5):
        awake.hand.broken.add("read")
        awake.live(BLIND - 0.05)
        awake.hand.broken.clear()
        awake.live(0.1)
    assert awake.enabled == [True]


def test_where_no_pin_cuts_nobody_is_told_that_one_did(awake: Kennel) -> None:
    awake.has_pin = False
    awake.hand.broken.add("read")
    awake.live(1.0)
    assert set(awake.child.words) == {HEARS}
    assert not [error for error in awake.node.errors if "its outputs are cut" in error]


def test_neutral_is_written_until_it_is_read_back_and_then_another_starts(awake: Kennel) -> None:
    awake.child.dead = True
    turn_deaf(awake.hand)
    awake.live(1.0)
    assert awake.child.starts == 1, "it started another beside a chip that is not at rest"
    assert awake.hand.log.count("start") >= 40
    assert "cannot bring the chip to rest: the chip does not take a start" in awake.node.errors
    awake.hand.broken.clear()
    awake.until(lambda: awake.restarted)
    assert awake.hand.pulses == NEUTRAL


def test_a_chip_that_takes_neutral_is_left_at_that(awake: Kennel) -> None:
    """Bringing it up takes many transfers, of which any may fail."""
    awake.hand.pulses = dict(MOVING)
    awake.hand.broken.add("start")
    awake.child.dead = True
    awake.hear_actuator()
    assert awake.hand.log[:2] == ["write", "read"]
    assert "start" not in awake.hand.log
    assert awake.hand.pulses == NEUTRAL


def test_a_chip_that_writes_do_not_reach_is_brought_up(awake: Kennel) -> None:
    """As one that lost its settings, or to which a single write did not get through."""
    awake.hand.pulses = dict(MOVING)
    awake.hand.broken.add("write")
    awake.child.dead = True
    awake.hear_actuator()
    assert awake.hand.log[:4] == ["write", "read", "start", "read"]
    assert awake.hand.pulses == NEUTRAL


def test_neutral_goes_out_before_a_stop_is_kept(awake: Kennel) -> None:
    kept, keep = [], awake.shelf.add

    def slowly(stop: Stop) -> None:
        kept.append(dict(awake.hand.pulses))
        keep(stop)

    awake.shelf.add = slowly
    awake.hand.pulses = dict(MOVING)
    awake.until(lambda: awake.shelf.stop)
    assert kept == [NEUTRAL]


def test_its_looks_leave_a_slow_bus_to_whoever_writes(awake: Kennel) -> None:
    read, looks = awake.hand.read, []

    def slowly(channels: Iterable[int]) -> dict[int, float | None]:
        looks.append(awake.clock.time)
        awake.clock.pass_by(0.1)
        return read(channels)

    awake.hand.read = slowly
    awake.live(3.0)
    assert all(later - earlier >= 0.1 * YIELD for earlier, later in pairwise(looks))
    assert len(looks) >= 3


def test_an_actuator_that_waits_for_a_slow_bus_is_not_killed_for_it(awake: Kennel) -> None:
    """Its looks tell how slow the bus is: as many transfers are between two steps of an actuator."""
    awake.dog._hand.took, awake.dog._hand._look_after = 0.3, float("inf")
    awake.child.frozen = True
    seconds = awake.until(lambda: awake.resting)
    assert ACTUATOR_SILENCE + 0.6 - STEADY_EVERY <= seconds <= ACTUATOR_SILENCE + 0.6 + 3 * STEP_EVERY


def test_however_long_a_look_took_an_actuator_that_stands_still_is_found(awake: Kennel) -> None:
    awake.dog._hand.took, awake.dog._hand._look_after = 3.0, float("inf")
    awake.child.frozen = True
    seconds = awake.until(lambda: awake.resting)
    assert seconds <= ACTUATOR_SILENCE + AT_MOST + 3 * STEP_EVERY


def test_looks_that_failed_under_one_actuator_do_not_cut_off_the_next(awake: Kennel) -> None:
    awake.hand.broken.add("read")
    awake.live(0.2)
    awake.hand.broken.clear()
    awake.child.dead = True
    awake.hear_actuator()
    awake.until(lambda: awake.restarted)
    awake.hand.broken.add("read")
    awake.live(0.2)
    assert awake.dog._hand._missed >= MISSES
    assert awake.enabled == [True, True]


def test_neutral_is_written_until_the_process_is_gone_as_well(awake: Kennel) -> None:
    """One that is stuck in the kernel may write once more when it comes loose."""
    awake.child.stuck = awake.child.frozen = True
    awake.until(lambda: awake.resting)
    awake.live(0.5)
    awake.hand.pulses = dict(MOVING)
    awake.live(STEP_EVERY)
    assert (awake.hand.pulses, awake.child.starts) == (NEUTRAL, 1)
    awake.hand.log.clear()
    awake.live(0.5)
    assert awake.hand.log.count("write") == pytest.approx(25, abs=1)
    awake.child.stuck = awake.child.frozen = awake.child.alive = False
    awake.until(lambda: awake.restarted)


def test_another_starts_after_the_childs_own_pause(awake: Kennel) -> None:
    awake.child.dead = True
    awake.hear_actuator()
    assert awake.until(lambda: awake.restarted) == pytest.approx(PAUSE, abs=2 * STEP_EVERY)
    assert awake.status.restarts == 1


def test_while_it_rests_it_says_so(awake: Kennel) -> None:
    awake.child.dead = True
    awake.hear_actuator()
    status = awake.status
    assert (status.state, status.why) == ("resting", "the actuator is gone: it ended")


def test_outputs_of_a_chip_that_takes_no_neutral_are_cut_until_an_actuator_steps_on_it(
    awake: Kennel,
) -> None:
    turn_deaf(awake.hand)
    awake.child.dead = True
    awake.hear_actuator()
    assert set(awake.enabled[1:]) == {False}
    awake.hand.broken.clear()
    awake.live(1.0)
    assert awake.restarted
    assert awake.enabled[-1]


def test_a_chip_that_does_not_keep_neutral_is_cut_off(awake: Kennel) -> None:
    awake.hand.start = awake.hand.write = lambda neutral_us: None
    awake.hand.pulses = dict(MOVING)
    awake.child.dead = True
    awake.hear_actuator()
    assert awake.enabled[-1] is False


def test_outputs_cut_by_a_moment_are_let_through_once_the_chip_is_at_rest(awake: Kennel) -> None:
    """The actuator lives on, so no other's first step would do it."""
    write, read = awake.hand.write, awake.hand.read

    def disturb_write(pulse_us: dict[int, float]) -> None:
        awake.hand.write, awake.hand.read = write, disturb_read
        raise DeviceError("noise")

    def disturb_read(channels: Iterable[int]) -> None:
        awake.hand.read = read
        raise DeviceError("noise")

    awake.hand.write = disturb_write
    awake.hear("stop", Stop(engaged=True, id=5, by="ann", why=""))
    awake.until(lambda: awake.shelf.stop)
    awake.live(2 * LOOK_EVERY)
    assert awake.enabled == [True, False, True]


@pytest.mark.parametrize("code", [1, 2])
def test_a_first_start_that_fails_ends_it_with_the_actuators_code(kennel: Kennel, code: int) -> None:
    """It has said why, in a sentence of its own: again and again would not help."""
    kennel.child.dead, kennel.child.code = True, code

    def spin() -> None:
        kennel.child.dead = True
        kennel.hear_actuator()
        assert kennel.node.stopped

    kennel.node.spin = spin
    assert kennel.dog.run() == code
    assert (kennel.child.starts, kennel.node.errors) == (1, [])
    assert not [line for line in kennel.node.infos if "its chip reads" in line], "there may be none"


def test_a_first_start_that_is_killed_is_tried_again(kennel: Kennel) -> None:
    kennel.child.code = -9

    def spin() -> None:
        kennel.child.dead = True
        kennel.hear_actuator()
        assert not kennel.node.stopped
        kennel.until(lambda: kennel.restarted)

    kennel.node.spin = spin
    assert kennel.dog.run() == 0


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_it_after_the_actuator_with_neutral_as_the_last_word(
    kennel: Kennel, number: int, handlers: dict[int, object], told: list[str]
) -> None:
    def spin() -> None:
        kennel.live(0.5)
        kennel.hand.pulses = dict(MOVING)
        kennel.hand.log.clear()
        kennel.child.log.clear()
        handlers[number](number, None)
        assert kennel.node.stopped

    kennel.node.spin = spin
    assert kennel.dog.run() == 128 + number
    assert kennel.child.log == ["ask", "end 0"]
    assert kennel.hand.log == ["write", "read", "close"]
    assert kennel.hand.pulses == NEUTRAL
    assert (kennel.enabled[-1], told[-1]) == (False, "STOPPING=1")
    assert kennel.node.infos[-1] == "ends: archangel is at rest, its chip reads neutral"


def test_it_tries_for_two_seconds_to_leave_neutral_behind(kennel: Kennel) -> None:
    def spin() -> None:
        kennel.live(0.5)
        turn_deaf(kennel.hand)

    kennel.node.spin = spin
    began = kennel.clock.time
    kennel.dog.run()
    assert kennel.clock.time - began == pytest.approx(0.5 + RESTS_WITHIN, abs=2 * STEP_EVERY)
    assert kennel.hand.log[-1] == "close"
    assert kennel.enabled[-1] is False
    assert kennel.node.errors[-1] == "ends, and archangel may move: neutral cannot be written; cut its power"


def test_whatever_goes_wrong_neutral_is_left_behind(kennel: Kennel) -> None:
    def spin() -> None:
        kennel.hand.pulses = dict(MOVING)
        raise ZeroDivisionError

    kennel.node.spin = spin
    with pytest.raises(ZeroDivisionError):
        kennel.dog.run()
    assert kennel.hand.pulses == NEUTRAL
    assert kennel.child.log[-1] == "end 0"


def test_while_an_actuator_hangs_in_its_end_neutral_is_written_again_and_again(kennel: Kennel) -> None:
    def spin() -> None:
        kennel.live(0.5)
        kennel.child.hangs = True
        kennel.hand.log.clear()

    kennel.node.spin = spin
    began = kennel.clock.time
    kennel.dog.run()
    assert kennel.clock.time - began == pytest.approx(0.5 + ENDS_WITHIN, abs=2 * STEP_EVERY)
    assert kennel.hand.log.count("write") > ENDS_WITHIN / STEP_EVERY


def test_a_chip_that_was_never_there_is_not_waited_for_long(kennel: Kennel) -> None:
    kennel.hand.broken.add("start")
    began = kennel.clock.time
    kennel.dog.run()
    assert kennel.clock.time - began < GRACE + 2 * STEP_EVERY
    assert kennel.node.errors == []


WENT = Standing(EPOCH, 999.0, 999.5, 999.6, 2, 7, 1000.0, 1000.5)


def stood(kennel: Kennel, standing: Standing) -> None:
    """Let an actuator report where it stands; whoever drives is heard here as well."""
    kennel.child.standing = standing
    kennel.hear("pwm/keyboard", Pwm(391, 413))
    kennel.live(0.1)


def test_an_actuator_that_was_only_late_is_followed_by_one_in_its_place(awake: Kennel) -> None:
    stood(awake, WENT)
    awake.child.frozen = True
    awake.until(lambda: awake.restarted)
    assert awake.child.followed == [None, WENT]


def test_one_that_crashed_or_would_not_stop_is_followed_by_a_start(awake: Kennel) -> None:
    stood(awake, WENT)
    awake.child.code, awake.child.dead = 1, True
    awake.until(lambda: awake.restarted)
    awake.live(0.1)
    awake.child.moves = True
    awake.until(lambda: awake.child.starts == 3)
    assert awake.child.followed == [None] * 3


def test_one_that_ended_because_the_watchdog_was_late_is_followed_by_one_in_its_place(awake: Kennel) -> None:
    stood(awake, WENT)
    awake.child.code, awake.child.dead = UNWATCHED, True
    awake.until(lambda: awake.restarted)
    assert awake.child.followed == [None, WENT]


def test_one_that_is_late_before_its_first_step_hands_on_what_it_was_told(awake: Kennel) -> None:
    stood(awake, WENT)
    awake.child.frozen = True
    awake.until(lambda: awake.child.starts == 3)
    assert awake.child.followed == [None, WENT, WENT]


def test_what_the_watchdog_slept_through_is_no_time_that_counted(awake: Kennel) -> None:
    """The actuator went on for half a second after that; its judge would stop whoever goes on by it."""
    heard = awake.clock.time
    stood(awake, WENT._replace(counted=heard + 0.5))
    awake.clock.pass_by(2.2)
    awake.child.code, awake.child.dead = UNWATCHED, True
    awake.until(lambda: awake.restarted)
    assert awake.child.followed[-1] == WENT._replace(counted=pytest.approx(heard, abs=2 * STEP_EVERY))


def test_who_was_never_heard_here_begins_anew(awake: Kennel) -> None:
    awake.child.standing = WENT
    awake.live(0.1)
    awake.child.frozen = True
    awake.until(lambda: awake.restarted)
    assert awake.child.followed == [None, WENT._replace(counted=0.0)]


def test_a_release_that_the_late_one_did_not_hear_ends_what_it_stood_for(awake: Kennel) -> None:
    stood(awake, WENT)
    awake.child.frozen = True
    awake.hear("stop", Stop(engaged=False, id=5, by="ann", why=""))
    before = awake.clock.time
    awake.until(lambda: awake.restarted)
    floor = awake.child.followed[-1].floor
    assert before <= floor <= awake.clock.time
    assert awake.child.followed[-1] == WENT._replace(floor=floor)


def test_beats_of_the_one_that_is_gone_are_not_the_next_ones(awake: Kennel) -> None:
    awake.child.frozen = True
    awake.until(lambda: awake.restarted)
    awake.child.frozen, awake.child.beats = False, False
    awake.child.words.clear()
    awake.live(0.2)
    assert set(awake.child.words) == {HEARS_NOT}


PRESSED = Stop(True, 7, "ann@desk", "a cat")


def ask(kennel: Kennel, stop: Stop = PRESSED) -> Answered:
    """Say a stop as a datagram, and return what is answered at the next tick."""
    answered = len(kennel.lane.answers)
    kennel.lane.ask(stop)
    kennel.until(lambda: len(kennel.lane.answers) > answered, 2 * STEADY_EVERY)
    return kennel.lane.answers[-1]


def test_a_stop_by_datagram_brings_neutral_at_once_and_the_actuator_is_told(awake: Kennel) -> None:
    awake.hand.pulses = dict(MOVING)
    ask(awake)
    assert awake.hand.log[0] == "write"
    assert awake.hand.pulses == NEUTRAL
    assert awake.child.stops == [PRESSED]


def test_it_is_confirmed_by_a_look_since_the_actuator_obeyed(awake: Kennel) -> None:
    awake.child.obeys = False
    answers = [ask(awake) for _ in range(5)]
    assert {(answer.held, answer.confirmed) for answer in answers} == {(True, "")}
    awake.child.obeys = True
    awake.until(lambda: ask(awake).confirmed == "read", 2 * LOOK_EVERY + 2 * STEP_EVERY)


def test_it_is_not_confirmed_while_the_chip_moves(awake: Kennel) -> None:
    awake.has_pin = False
    turn_deaf(awake.hand)
    answers = [ask(awake) for _ in range(10)]
    assert {answer.confirmed for answer in answers} == {""}


def test_one_that_moves_on_although_it_was_stopped_by_datagram_is_killed(awake: Kennel) -> None:
    awake.child.moves = True
    ask(awake)
    assert awake.until(lambda: awake.resting) < GRACE + MISSES * LOOK_EVERY + 2 * STEP_EVERY
    awake.child.moves = False
    assert ask(awake).confirmed == "read"


def test_it_is_told_to_the_actuator_once_and_answered_each_time(awake: Kennel) -> None:
    assert [ask(awake).id for _ in range(5)] == [7] * 5
    assert len(awake.child.stops) == 1


def test_after_its_release_the_same_stop_is_no_longer_held(awake: Kennel) -> None:
    ask(awake)
    awake.hear("stop", Stop(False, 7, "ann@desk", ""))
    awake.live(2 * STEADY_EVERY)
    assert not ask(awake).held
    assert len(awake.child.stops) == 1


def test_without_an_actuator_it_is_kept_and_the_next_one_told(awake: Kennel) -> None:
    awake.child.dead = True
    awake.until(lambda: awake.resting)
    answer = ask(awake)
    assert (answer.confirmed, awake.shelf.stops) == ("read", [PRESSED])
    awake.until(lambda: awake.restarted and PRESSED in awake.child.stops)


def test_a_stop_that_no_disk_has_yet_is_answered_so(awake: Kennel) -> None:
    assert ask(awake).unkept == "it is being written"
    awake.shelf.stops.append(PRESSED)
    awake.live(2 * STEADY_EVERY)
    assert ask(awake).unkept == ""


def looks(kennel: Kennel, seconds: float) -> int:
    """Return how often it takes in what is said, in a time."""
    taken, take = [], kennel.lane.take
    kennel.lane.take = lambda now: taken.append(now) or take(now)  # type: ignore[method-assign, func-returns-value]
    kennel.live(seconds)
    return len(taken)


def test_it_looks_often_only_while_the_chip_moves(awake: Kennel) -> None:
    assert looks(awake, 1.0) == pytest.approx(1.0 / STEADY_EVERY, abs=1)
    awake.hand.pulses = dict(MOVING)
    awake.child.moves = True
    awake.hear("pwm/keyboard", PUSH)
    awake.live(2 * LOOK_EVERY)
    assert looks(awake, 0.2) >= 0.2 / STEP_EVERY - 1


def test_it_hears_often_while_somebody_floods(awake: Kennel, monkeypatch: pytest.MonkeyPatch) -> None:
    ticks, hear = list[float](), awake.child.hear

    def count(now: float) -> None:
        ticks.append(now)
        hear(now)

    monkeypatch.setattr(awake.child, "hear", count)
    for _ in range(20):
        for _ in range(100):
            awake.hear("pwm/keyboard", PUSH)
        awake.live(STEP_EVERY)
    assert len(ticks) >= 17, "and not every third time alone"


def test_an_actuator_whose_end_somebody_else_holds_has_ended(awake: Kennel) -> None:
    awake.child.alive = False  # and its link says nothing of that
    awake.hear_actuator()
    assert awake.resting


def test_a_step_that_came_while_its_reports_were_read_is_no_silence(
    awake: Kennel, monkeypatch: pytest.MonkeyPatch
) -> None:
    hear = awake.child.hear

    def hear_late(now: float) -> None:
        """Read a report of a step that was made after the tick had looked at the clock."""
        awake.clock.pass_by(0.0001)
        hear(now + 0.0001)

    monkeypatch.setattr(awake.child, "hear", hear_late)
    awake.live(5.0)
    assert (awake.child.starts, awake.resting) == (1, False)


def test_reports_are_heard_although_they_wake_nobody(awake: Kennel) -> None:
    for _ in range(50):
        awake.node.live(STEP_EVERY)
    assert not awake.resting
    assert awake.child.silence(awake.clock.time) <= STEADY_EVERY
