from types import SimpleNamespace

import pytest

from zteleop.control.deadlines import LINK_LOSS
from zteleop.control.mixer import Differential
from zteleop.control.report import to_vehicle
from zteleop.control.servo import Servo
from zteleop.control.settings import DriveSettings
from zteleop.control.stick import Speeds, Stick
from zteleop.errors import BusError, ConfigError
from zteleop.inputs import Wish
from zteleop.messages import DriveStatus, Log, Odometry, Pwm, Stop, Twist, Vehicle, WatchdogStatus
from zteleop.nodes import sight
from zteleop.nodes.stop_request import ACKNOWLEDGED_WITHIN, REPEAT
from zteleop.nodes.teleop import AT_REST, LEAVING, NEWS, PERIOD, SHOW_AFTER, Teleop
from zteleop.screen.view import View
from zteleop.testing import Clock, FakeNode

CAR = to_vehicle(DriveSettings(), 4.08)
SLOW_CAR = to_vehicle(DriveSettings(), 4.1)
TANK = to_vehicle(
    DriveSettings(mixer=Differential(), servos={"left": Servo(channel=0), "right": Servo(channel=1)}), 4.08
)
NEUTRAL = Pwm(375, 370)


class Device:
    """An input whose stick and acts are what the test says."""

    def __init__(self, drive: str = "hold") -> None:
        self.drive, self.speeds, self.finished = drive, Speeds(), False
        self.position, self.acted = Stick(), False
        self.rested = False
        self.wish: Wish | None = None
        self.fitted: list[Vehicle] = []
        self.resets: list[float] = []
        self.file: int | None = None

    def fileno(self) -> int | None:
        return self.file

    def fit(self, vehicle: Vehicle) -> None:
        if self.drive == "step" and vehicle.kind != "ackermann":
            raise ConfigError("driving in steps needs the channels steering and throttle")
        self.fitted.append(vehicle)

    def read(self, now: float) -> bool:
        return self.acted

    def stick(self, now: float) -> Stick:
        return self.position

    def reset(self, now: float) -> None:
        self.resets.append(now)


class Desk:
    """One operator at one device."""

    def __init__(self, node: FakeNode, clock: Clock, device: Device, vehicle: Vehicle = CAR) -> None:
        self.node, self.clock, self.device = node, clock, device
        self.views: list[View] = []
        self.teleop = Teleop(node, device, "keyboard", vehicle, self.views.append)
        self.twists, self.pwms, self.stops = node.said["cmd_vel"], node.said["pwm"], node.said["stop"]

    def hear_state(self, state: str, stop: int = 0) -> None:
        status = DriveStatus.zero()
        status.state, status.why = state, f"it is {state}"
        status.stops = [Stop(True, stop, "the watchdog", "")] if stop else []
        status.confirmed = "read" if stop else ""
        self.node.inboxes["drive_status"].waiting.append(status)

    def hear_log(self, text: str, name: str = "actuator", level: int = Log.WARN) -> None:
        log = Log.zero()
        log.name, log.level, log.msg = name, level, text
        self.node.inboxes["log"].waiting.append(SimpleNamespace(message=log))

    def tick(self, times: int = 1, beats: bool = True) -> None:
        for _ in range(times):
            self.clock.pass_by(PERIOD)
            if beats:
                self.node.hear_beat()
            self.teleop.obey()
            self.node.loop.ring(self.clock.time + SHOW_AFTER)


@pytest.fixture
def desk(node: FakeNode, clock: Clock) -> Desk:
    return Desk(node, clock, Device())


@pytest.fixture
def steps(node: FakeNode, clock: Clock) -> Desk:
    return Desk(node, clock, Device("step"))


def test_it_speaks_as_its_source(desk: Desk) -> None:
    assert (desk.twists.topic, desk.pwms.topic) == ("cmd_vel/keyboard", "pwm/keyboard")
    assert desk.device.fitted == [CAR]


def test_an_idle_device_says_nothing(desk: Desk) -> None:
    desk.tick(100)
    assert desk.twists.messages == desk.pwms.messages == []


def test_a_held_stick_is_said_at_every_tick(desk: Desk) -> None:
    desk.device.position = Stick(1.0, 0.0, deadman=True)
    desk.tick(5)
    assert [said.twist for said in desk.twists.take()] == [Twist.planar(0.5)] * 5
    assert desk.pwms.messages == []


def test_a_lever_is_said_as_pulses(steps: Desk) -> None:
    steps.device.position = Stick(1.0, -1.0, deadman=True)
    steps.tick(2)
    assert steps.pwms.take() == [Pwm(290, 500)] * 2
    assert steps.twists.messages == []


def test_neutral_is_said_three_times_and_then_nothing(desk: Desk, steps: Desk) -> None:
    desk.device.position = Stick(1.0, 0.0, deadman=True)
    desk.tick(3)
    desk.twists.take()
    desk.device.position = Stick()
    desk.tick(10)
    assert [said.twist for said in desk.twists.take()] == [Twist.planar()] * 3


def test_neutral_ends_the_claim(desk: Desk) -> None:
    desk.device.position = Stick(1.0, 0.0, deadman=True)
    desk.tick(3)
    assert desk.twists.lets_go == 0
    desk.device.position = Stick()
    desk.tick(10)
    assert desk.twists.lets_go == 3


def test_whoever_lets_go_and_presses_again_at_once_begins_anew(steps: Desk) -> None:
    steps.device.position = Stick(1.0, 0.0, deadman=True)
    steps.tick()
    steps.device.rested = True
    steps.tick(2)
    first, rest, *again = steps.pwms.take()
    assert (rest, again) == (NEUTRAL, [first, first])
    assert (steps.pwms.lets_go, steps.device.rested) == (1, False)


def test_neutral_of_levers_is_the_vehicles_own(steps: Desk) -> None:
    steps.device.position = Stick(1.0, 0.0, deadman=True)
    steps.tick()
    steps.device.position = Stick()
    steps.tick(10)
    assert steps.pwms.take()[1:] == [NEUTRAL] * 3


def test_whoever_drives_again_says_neutral_three_times_again(desk: Desk) -> None:
    for stick, ticks in ((Stick(1.0, 0.0, True), 1), (Stick(), 2), (Stick(1.0, 0.0, True), 1), (Stick(), 9)):
        desk.device.position = stick
        desk.tick(ticks)
    assert [said.twist.linear.x for said in desk.twists.take()] == [0.5, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0]


def test_a_stick_held_at_rest_is_a_command(desk: Desk) -> None:
    desk.device.position = Stick(0.0, 0.0, deadman=True)
    desk.tick(10)
    assert len(desk.twists.messages) == 10


def test_only_what_the_operator_does_is_an_act(desk: Desk) -> None:
    desk.device.position = Stick(1.0, 0.0, deadman=True)
    desk.tick(20)
    assert desk.twists.acts == desk.pwms.acts == 0
    desk.device.acted = True
    desk.tick(2)
    assert desk.twists.acts == desk.pwms.acts == 2


def test_a_robot_that_started_anew_finds_the_device_at_rest(desk: Desk, clock: Clock) -> None:
    desk.tick(3)
    desk.device.resets.clear()
    desk.node.hear_beat(epoch=2)
    desk.teleop.obey()
    assert desk.device.resets == [clock.time]
    desk.tick(0)
    desk.teleop.obey()
    assert len(desk.device.resets) == 1


def test_after_two_seconds_without_a_beat_the_device_is_let_go_once(desk: Desk, clock: Clock) -> None:
    desk.tick(3)
    desk.device.resets.clear()
    desk.tick(round(LINK_LOSS / PERIOD) - 1, beats=False)
    assert desk.device.resets == []
    desk.tick(20, beats=False)
    assert len(desk.device.resets) == 1
    desk.tick(20)
    assert len(desk.device.resets) == 2


def test_what_was_held_when_the_robot_restarted_is_not_said(desk: Desk, clock: Clock) -> None:
    desk.device.position = Stick(1.0, 0.0, deadman=True)
    desk.tick(3)
    desk.twists.take()
    desk.device.reset = lambda now: setattr(desk.device, "position", Stick())
    desk.node.hear_beat(epoch=2)
    desk.teleop.obey()
    assert [said.twist for said in desk.twists.take()] == [Twist.planar()]
    desk.tick(beats=False)
    assert desk.views[-1].note == sight.LOST


@pytest.mark.parametrize(("state", "note"), [("stopped", ""), ("starting", sight.LOST)])
def test_what_a_start_takes_back_is_told_and_a_stop_tells_itself(desk: Desk, state: str, note: str) -> None:
    desk.hear_state("idle")
    desk.device.position = Stick(1.0, 0.0, deadman=True)
    desk.tick(3)
    desk.hear_state(state)
    desk.device.reset = lambda now: setattr(desk.device, "position", Stick())
    desk.tick()
    assert desk.views[-1].note == note


def test_another_calibration_is_learnt_once(steps: Desk, clock: Clock) -> None:
    steps.node.hear_beat(vehicle=SLOW_CAR)
    steps.tick(3)
    assert steps.device.fitted == [CAR, SLOW_CAR]
    steps.device.position = Stick(1.0, 0.0, deadman=True)
    steps.tick()
    assert steps.pwms.take() == [Pwm(373, 498)]


def test_run_obeys_on_a_clock_and_whenever_the_device_can_be_read(desk: Desk) -> None:
    desk.device.file = 7
    desk.teleop.run()
    clocks = [(timer.period, timer.action) for timer in desk.node.loop.timers if timer.period]
    assert (AT_REST, desk.teleop.obey) in clocks
    assert desk.node.loop.watched == {7: desk.teleop.obey}


def test_where_nobody_drives_it_looks_less_often(desk: Desk) -> None:
    looks: list[float] = []
    desk.device.read = looks.append
    desk.node.loop.live(1.0)
    assert len(looks) == pytest.approx(1.0 / AT_REST, abs=1)
    desk.hear_state("driving")  # somebody else
    desk.teleop.obey()
    looks.clear()
    desk.node.loop.live(0.5)
    assert len(looks) == pytest.approx(0.5 / PERIOD, abs=1)
    desk.hear_state("idle")
    desk.teleop.obey()
    looks.clear()
    desk.node.loop.live(1.0)
    assert len(looks) == pytest.approx(1.0 / AT_REST, abs=1)


@pytest.mark.parametrize("what", ["stick", "stop"])
def test_whoever_drives_or_stops_is_looked_at_at_every_tick(desk: Desk, what: str) -> None:
    if what == "stick":
        desk.device.position = Stick(1.0, 0.0, deadman=True)
    else:
        desk.device.wish = Wish.STOP
    desk.teleop.obey()
    desk.device.position = Stick()
    looks: list[float] = []
    desk.device.read = looks.append
    desk.node.loop.live(2.5 * PERIOD)  # the first at once: as many as the neutrals it says
    assert len(looks) == 3


def test_what_an_act_took_to_the_bus_is_told_by_the_name_that_everything_calls_this_input(desk: Desk) -> None:
    desk.device.position = Stick(1.0, 0.0, deadman=True)
    desk.device.acted = False
    desk.tick(3)
    assert not desk.node.said["latency"].messages, "what only goes on is no act"
    desk.device.acted = True
    desk.device.stick = lambda now: desk.clock.pass_by(0.003) or desk.device.position
    desk.tick()
    desk.device.acted = False
    desk.node.loop.live(1.1)
    (told,) = desk.node.said["latency"].messages
    assert told.by == "keyboard 0001"
    assert desk.node.said["cmd_vel"].sender == "1"
    assert [(hop.name, hop.commands, round(hop.median, 6)) for hop in told.hops] == [("act to bus", 1, 0.003)]


def test_in_steps_it_is_called_by_what_says_ticks_in_a_stop_as_well(desk: Desk) -> None:
    desk.device.drive, desk.device.wish = "step", Wish.STOP
    desk.tick()
    assert (desk.node.said["pwm"].sender, desk.stops.messages[0].why) == ("2", "at keyboard 0002")


def test_a_device_without_a_file_is_not_watched(desk: Desk) -> None:
    desk.teleop.run()
    assert desk.node.loop.watched == {}


@pytest.mark.parametrize("ending", [KeyboardInterrupt, SystemExit, ZeroDivisionError, None])
def test_the_last_word_is_neutral_however_it_ends(desk: Desk, ending: type[BaseException] | None) -> None:
    def spin() -> None:
        desk.device.position = Stick(1.0, 0.0, deadman=True)
        desk.tick(3)
        if ending:
            raise ending

    desk.node.spin = spin
    if ending:
        with pytest.raises(ending):
            desk.teleop.run()
    else:
        desk.teleop.run()
    assert [said.twist.linear.x for said in desk.twists.take()] == [0.5, 0.5, 0.5, 0.0]
    assert desk.twists.acts == 0


def test_the_last_word_of_levers_is_neutral_too(steps: Desk) -> None:
    steps.teleop.run()
    assert steps.pwms.take() == [NEUTRAL]


def test_it_ends_when_the_operator_has_enough(desk: Desk) -> None:
    desk.tick()
    assert not desk.node.stopped
    desk.device.finished = True
    desk.tick()
    assert desk.node.stopped


def test_a_robot_that_comes_back_as_another_kind_is_not_driven_and_said_why(
    steps: Desk, clock: Clock
) -> None:
    steps.tick(3)
    steps.pwms.take()
    steps.node.hear_beat(epoch=2, vehicle=TANK)
    steps.teleop.obey()
    assert steps.pwms.take() == []
    assert "cannot be driven like this: driving in steps needs" in steps.node.warnings[-1]


def test_what_there_is_to_see_is_shown_at_every_tick(desk: Desk, clock: Clock) -> None:
    status, odom = DriveStatus.zero(), Odometry.zero()
    status.operator = desk.twists.sender
    desk.hear_log("it smells")
    desk.node.inboxes["drive_status"].waiting.append(status)
    desk.node.inboxes["odom"].waiting.append(odom)
    desk.device.position = Stick(1.0, 0.0, deadman=True)
    desk.tick(2)
    view = desk.views[-1]
    assert (view.now, view.vehicle, view.stick) == (clock.time, CAR, desk.device.position)
    assert (view.status, view.ours, view.odom, view.note) == (status, True, odom, "actuator: it smells")
    assert view.command == Twist.planar(0.5)


def test_a_status_long_unheard_is_no_status(desk: Desk) -> None:
    desk.node.inboxes["drive_status"].waiting.append(DriveStatus.zero())
    desk.tick(round(LINK_LOSS / PERIOD))
    assert desk.views[-1].status is not None
    desk.tick(2)
    assert desk.views[-1].status is None


@pytest.mark.parametrize(("operator", "ours"), [("", False), ("ff", False), ("1", True)])
def test_the_robot_is_ours_when_it_says_so(desk: Desk, operator: str, ours: bool) -> None:
    status = DriveStatus.zero()
    status.operator = operator
    desk.node.inboxes["drive_status"].waiting.append(status)
    desk.tick()
    assert desk.views[-1].ours is ours


def test_a_stop_is_passed_on_once_repeated_and_lets_go(desk: Desk, clock: Clock) -> None:
    desk.tick(3)
    desk.device.resets.clear()
    desk.device.wish = Wish.STOP
    desk.tick()
    stop = desk.stops.messages[0]
    assert (stop.engaged, stop.why) == (True, "at keyboard 0001"), "one name for one sender everywhere"
    assert "@" in stop.by
    assert desk.device.wish is None
    assert desk.device.resets == [clock.time]
    desk.tick(9)
    assert desk.stops.take() == [stop] * 10
    desk.hear_state("stopped", stop.id)
    desk.tick(round(REPEAT / PERIOD))
    assert len(desk.stops.take()) == pytest.approx(REPEAT / PERIOD - 10, abs=2), "for 3 s, answered or not"
    desk.tick(9)
    assert desk.stops.take() == []


def test_a_stop_says_neutral_with_it(desk: Desk) -> None:
    desk.device.position = Stick(1.0, 0.0, deadman=True)
    desk.tick(3)
    desk.twists.take()
    desk.device.reset = lambda now: setattr(desk.device, "position", Stick())
    desk.device.wish = Wish.STOP
    desk.tick(1)
    assert len(desk.stops.take()) == 1
    assert [said.twist for said in desk.twists.take()] == [Twist.planar()]


def test_the_answer_to_a_stop_is_the_note_for_a_while(desk: Desk) -> None:
    desk.device.wish = Wish.STOP
    desk.tick()
    assert desk.views[-1].note == "asking archangel to stop"
    desk.hear_state("stopped", desk.stops.messages[0].id)
    desk.tick()
    desk.hear_log("stopped: by ann")
    desk.tick()
    assert desk.views[-1].note == "archangel is stopped (neutral read back from the chip within 50 ms)"
    desk.tick(round(NEWS / PERIOD))
    assert desk.views[-1].note == "actuator: stopped: by ann"
    assert not any(view.alarm for view in desk.views)


def test_an_answer_to_a_stop_that_somebody_has_released_is_no_news(desk: Desk) -> None:
    desk.device.wish = Wish.STOP
    desk.tick()
    desk.hear_state("stopped", desk.stops.messages[0].id)
    desk.tick()
    assert desk.views[-1].note.startswith("archangel is stopped")
    desk.hear_state("idle")
    desk.tick()
    assert desk.views[-1].note == ""


@pytest.mark.parametrize("words", ["keyboard 18d4 is refused: it is too old", "the chip was silent"])
def test_a_refusal_is_no_news_once_the_robot_does_something_else(desk: Desk, words: str) -> None:
    desk.hear_state("stopped", 7)
    desk.tick()
    desk.hear_log(words)
    desk.tick()
    assert desk.views[-1].note == f"actuator: {words}"
    desk.hear_state("idle")
    desk.tick()
    assert desk.views[-1].note == ("" if "refused" in words else f"actuator: {words}")


def test_a_stop_that_nobody_acknowledges_stays_an_alarm_until_somebody_does(desk: Desk) -> None:
    desk.device.wish = Wish.STOP
    desk.tick(round((ACKNOWLEDGED_WITHIN + NEWS + 1) / PERIOD), beats=False)
    desk.hear_log("anything")
    desk.tick(beats=False)
    assert desk.views[-1].alarm
    assert desk.views[-1].note.startswith("archangel has not acknowledged the stop within 2 s: cut its power")
    desk.device.wish = Wish.STOP
    desk.tick()
    assert not desk.views[-1].alarm
    desk.hear_state("stopped", desk.stops.messages[-1].id)
    desk.tick()
    assert not desk.views[-1].alarm


def test_a_release_names_the_stop_on_the_screen(desk: Desk) -> None:
    desk.hear_state("stopped", 7)
    desk.tick()
    desk.device.wish = Wish.RELEASE
    desk.tick(3)
    assert {(said.engaged, said.id) for said in desk.stops.take()} == {(False, 7)}
    assert desk.views[-1].note == "asking archangel to end its stop"
    desk.hear_state("idle")
    desk.tick()
    assert desk.views[-1].note == "archangel may drive again, from neutral (acknowledged within 150 ms)"
    assert desk.stops.messages == []


def test_a_robot_that_is_not_heard_is_not_released(desk: Desk) -> None:
    desk.hear_state("stopped", 7)
    desk.tick(round(LINK_LOSS / PERIOD) + 2, beats=False)
    desk.device.wish = Wish.RELEASE
    desk.tick(beats=False)
    assert desk.stops.messages == []
    assert desk.views[-1].note.startswith("archangel is not heard")
    assert not desk.views[-1].alarm


@pytest.mark.parametrize("state", ["stopped", "fault", "starting"])
def test_a_robot_kept_at_rest_finds_the_device_at_rest_and_again_when_it_is_free(
    desk: Desk, clock: Clock, state: str
) -> None:
    desk.hear_state("driving")
    desk.tick(3)
    desk.device.resets.clear()
    for _ in range(2):
        desk.hear_state(state, 7)
        desk.tick(3)
        assert len(desk.device.resets) == 1
    desk.hear_state("idle")
    desk.tick()
    assert desk.device.resets[1:] == [clock.time]
    for calm in ("driving", "operator idle", "idle", "link lost"):
        desk.hear_state(calm)
        desk.tick()
    assert len(desk.device.resets) == 2


def test_whoever_stops_and_leaves_is_heard_first(desk: Desk) -> None:
    desk.device.wish, desk.device.finished = Wish.STOP, True
    desk.tick(5)
    assert not desk.node.stopped
    desk.hear_state("stopped", desk.stops.messages[0].id)
    desk.tick(round((REPEAT - 0.5) / PERIOD))
    assert not desk.node.stopped
    assert desk.views[-1].note == LEAVING, "what the screen still stands for"
    desk.tick(round(0.5 / PERIOD))
    assert desk.node.stopped


def test_whoever_leaves_after_a_stop_that_nobody_acknowledged_is_told(desk: Desk) -> None:
    desk.device.wish, desk.device.finished = Wish.STOP, True
    desk.node.spin = lambda: desk.tick(round(REPEAT / PERIOD) + 2, beats=False)
    with pytest.raises(BusError, match="archangel has not acknowledged the stop"):
        desk.teleop.run()
    assert desk.node.stopped


def test_what_was_heard_before_a_stop_does_not_answer_it(desk: Desk) -> None:
    desk.hear_state("stopped", 7)
    desk.tick()
    desk.device.wish = Wish.STOP
    desk.tick(round(ACKNOWLEDGED_WITHIN / PERIOD) + 2, beats=False)
    assert desk.views[-1].alarm


def test_what_was_typed_while_the_process_stood_still_is_dropped(desk: Desk, clock: Clock) -> None:
    desk.tick(3)
    desk.device.resets.clear()
    clock.pass_by(0.6)
    desk.node.hear_beat()
    desk.teleop.obey()
    assert desk.device.resets == [clock.time]
    desk.tick(3)
    assert len(desk.device.resets) == 1


def test_a_stop_typed_while_the_process_stood_still_counts_and_a_release_does_not(
    desk: Desk, clock: Clock
) -> None:
    desk.hear_state("stopped", 7)
    desk.tick()
    for wish, said in ((Wish.RELEASE, []), (Wish.STOP, [True])):
        clock.pass_by(0.6)
        desk.device.wish = wish
        desk.tick()
        assert [stop.engaged for stop in desk.stops.take()] == said
        assert desk.device.wish is None


def test_its_own_refusal_is_shown(desk: Desk) -> None:
    desk.twists.refused = "it is too old (deaf)"
    desk.tick(2)
    assert (desk.views[-1].refused, desk.views[-1].note) == ("it is too old (deaf)", "")


def test_a_line_of_the_log_is_shown_while_it_is_news(desk: Desk) -> None:
    desk.hear_log("obeys archangel")
    desk.tick(2)
    assert desk.views[-1].note == "actuator: obeys archangel"
    desk.hear_log("cmd_vel is refused", name="publisher")
    desk.hear_log("driving: keyboard 18d4 drives", level=Log.INFO)
    desk.tick(2)
    assert desk.views[-1].note == "actuator: obeys archangel", (
        "the status says the one, its operator reads the other"
    )
    desk.tick(int(sight.NEWS / PERIOD) + 2)
    assert desk.views[-1].note == ""


def test_what_was_said_last_is_doubted_soon_and_where_it_is_is_forgotten(desk: Desk) -> None:
    desk.hear_state("driving")
    odom = Odometry.zero()
    desk.node.inboxes["odom"].waiting.append(odom)
    desk.tick()
    seen = desk.views[-1]
    assert (seen.silence, seen.odom, seen.odom_lost) == (0.0, odom, False)
    desk.tick(10)
    assert desk.views[-1].silence == 0.0, "its beats say that what it said last is so still"
    desk.tick(10, beats=False)
    assert desk.views[-1].silence == pytest.approx(0.5)
    desk.tick(round(sight.ODOM_LASTS / PERIOD))
    assert (desk.views[-1].odom, desk.views[-1].odom_lost) == (None, True)
    desk.hear_state("idle")
    desk.tick()
    assert desk.views[-1].silence == 0.0


@pytest.mark.parametrize(
    ("state", "word", "words"),
    [
        ("ended", "ended", "it is at rest; `zteleop actuator --robot archangel` starts it again"),
        ("resting", "restarting", "it is at rest; the chip is kept at rest, and another starts"),
    ],
)
def test_a_robot_without_an_actuator_is_told_by_its_watchdog_until_there_is_one(
    desk: Desk, state: str, word: str, words: str
) -> None:
    desk.hear_state("driving")
    desk.tick()
    dog = WatchdogStatus.zero()
    dog.state, dog.why = state, "it is at rest"  # type: ignore[assignment]
    desk.hear_log("keyboard 18d4 is refused: it is too old")
    desk.tick()
    assert "refused" in desk.views[-1].note
    desk.node.inboxes["watchdog"].waiting.append(dog)
    desk.tick()
    assert (desk.views[-1].unmanned, desk.views[-1].status) == ((word, words), None)
    assert desk.views[-1].note == ""
    desk.hear_state("idle")
    desk.tick()
    assert desk.views[-1].unmanned is None
    assert desk.views[-1].status is not None


def test_a_robot_that_was_started_anew_is_said_to_be(desk: Desk) -> None:
    desk.tick()
    beat = desk.node.membership.heard().beat
    assert beat
    desk.node.hear_beat(beat.epoch + 1)
    desk.tick(beats=False)
    assert desk.views[-1].note == sight.ANEW


def test_what_was_in_the_way_is_said_no_more_once_the_robot_drives(desk: Desk) -> None:
    desk.hear_state("idle")
    desk.hear_log("keyboard 7 is refused: too late")
    desk.tick()
    assert desk.views[-1].note
    desk.hear_state("driving")
    desk.tick()
    assert desk.views[-1].note == ""


def test_the_advice_for_somebody_else_who_is_refused_is_not_for_who_drives(desk: Desk) -> None:
    desk.hear_log("keyboard 7 is refused: it is too old; look at the link")
    desk.hear_log("the chip was silent; look at its wires", name="watchdog")
    desk.tick()
    assert desk.views[-1].note == "watchdog: the chip was silent; look at its wires"
    desk.hear_log("keyboard 7 is refused: it is too old; look at the link")
    desk.tick()
    assert desk.views[-1].note == "actuator: keyboard 7 is refused: it is too old"
