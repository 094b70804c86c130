import pytest
from unit.nodes.fakes import Shelf

from zteleop.bus.subscription import Received
from zteleop.control.deadlines import DEAF_AFTER, GRACE
from zteleop.control.judge import Judge
from zteleop.control.mux import Source
from zteleop.control.proof import Proof, Prover
from zteleop.control.settings import SOURCES, DriveSettings
from zteleop.control.standing import Standing
from zteleop.machine.stop_file import UNREADABLE
from zteleop.messages import Beat, Message, Pwm, Stop, String
from zteleop.nodes.overhear import MANY, Overhearing
from zteleop.testing import FakeNode

PERIOD = 0.02
PUSH = Pwm(390, 370)
STOP = Stop(engaged=True, id=5, by="ann", why="")
RELEASE = Stop(engaged=False, id=5, by="ann", why="")


class Room:
    """A watchdog's ears, a clock, and somebody who talks."""

    def __init__(self) -> None:
        self.now, self.node, self.shelf = 100.0, FakeNode(), Shelf()
        settings = DriveSettings(sources={"nav": Source(10)})
        self.judge = Judge(settings, 4.08, self.now)
        self.judge.hear_report(Standing(1, *[self.now - 1.0] * 3))
        self.ears = Overhearing(self.node, settings, self.judge, self.shelf)
        self.prover = Prover(7)

    def hear(self, topic: str, message: Message, proof: Proof | None = None) -> None:
        self.node.inboxes[topic].waiting.append(
            Received(message, f"robot/archangel/{topic}", proof, self.now)
        )

    def push(self, topic: str = "pwm/keyboard") -> None:
        beat = Beat(1, self.now, 0.0)
        self.prover.act(beat)
        self.hear(topic, PUSH, self.prover.prove(beat, True, self.now))

    def beat(self, epoch: int) -> None:
        self.hear("beat", Beat(epoch, self.now, 0.0))

    def listen(self, seconds: float = PERIOD) -> Stop | None:
        """Tick on; return the stop that was ignored, if any."""
        for _ in range(round(seconds / PERIOD)):
            self.now += PERIOD
            if found := self.ears.listen(self.now):
                return found
        return None


@pytest.fixture
def room() -> Room:
    return Room()


def test_a_flood_is_noticed_as_long_as_it_lasts(room: Room) -> None:
    room.push()
    room.listen()
    assert not room.ears.floods
    for _ in range(MANY + 1):
        room.push()
    room.listen()
    assert room.ears.floods
    room.listen()
    assert not room.ears.floods


def test_it_hears_every_source_by_name_and_the_stops(room: Room) -> None:
    commands = {f"{t}/{s}" for t in ("cmd_vel", "pwm") for s in (*SOURCES, "nav")}
    assert set(room.node.inboxes) == {*commands, "beat", "stop"}


@pytest.mark.parametrize("topic", ["pwm/keyboard", "cmd_vel/program", "pwm/nav"])
def test_what_is_said_is_judged(room: Room, topic: str) -> None:
    assert not room.judge.allowed(room.now)
    room.push(topic)
    room.listen()
    assert room.judge.allowed(room.now)
    assert room.ears.commands == 1


def test_what_commands_nothing_or_proves_nothing_permits_nothing(room: Room) -> None:
    room.hear("pwm/keyboard", String("go"))
    room.hear("pwm/keyboard", PUSH)
    room.hear("pwm/keyboard", PUSH, Proof(1, 1, 99, 100.0, 100.0, 100.0))
    room.listen()
    assert not room.judge.allowed(room.now)
    assert room.ears.commands == 3


def test_a_stop_that_is_kept_is_left_to_the_actuator(room: Room) -> None:
    room.hear("stop", STOP)
    room.listen()
    room.shelf.add(STOP)
    assert room.listen(2.0) is None
    assert room.judge.stopped


def test_a_stop_that_the_actuator_ignores_comes_back_after_a_quarter_of_a_second_once(room: Room) -> None:
    room.hear("stop", STOP)
    room.listen()
    heard = room.now
    assert room.judge.stopped
    assert room.listen(2.0) == STOP
    assert GRACE < room.now - heard <= GRACE + 2 * PERIOD
    assert room.listen(2.0) is None


def test_a_stop_that_is_repeated_is_asked_for_since_the_first_time(room: Room) -> None:
    for _ in range(round(GRACE / PERIOD) + 3):
        room.hear("stop", STOP)
        if found := room.listen():
            break
    assert found == STOP


def test_late_repeats_of_a_stop_that_is_over_stop_nothing(room: Room) -> None:
    room.hear("stop", STOP)
    room.shelf.add(STOP)
    room.listen()
    room.shelf.remove()
    room.hear("stop", STOP)
    assert room.listen(1.0) is None
    assert not room.judge.stopped


def test_a_stop_that_is_released_before_it_was_seen_in_the_file_was_not_ignored(room: Room) -> None:
    room.hear("stop", STOP)
    room.listen()
    room.hear("stop", RELEASE)
    assert room.listen(1.0) is None
    assert not room.judge.stopped


def test_of_two_stops_in_the_file_the_one_that_is_ignored_comes_back(room: Room) -> None:
    room.shelf.add(STOP)
    room.listen(0.1)
    other = Stop(engaged=True, id=6, by="bob", why="")
    room.hear("stop", other)
    assert room.listen(1.0) == other


def test_what_leaves_the_file_is_over_and_what_stays_is_not(room: Room) -> None:
    other = Stop(engaged=True, id=6, by="bob", why="")
    for said in (STOP, other):
        room.hear("stop", said)
        room.shelf.add(said)
    room.listen(0.1)
    room.shelf.keep([other])
    room.listen(0.1)
    assert room.ears.stops == (other,)
    assert room.judge.stopped
    room.shelf.remove()
    room.listen(0.1)
    assert room.ears.stops == ()
    assert not room.judge.stopped


def test_a_file_that_cannot_be_read_for_a_moment_ends_no_stop(room: Room) -> None:
    room.hear("stop", STOP)
    room.shelf.add(STOP)
    room.listen(0.1)
    for content in ([Stop(engaged=True, id=UNREADABLE, by="nobody known", why="")], [STOP]):
        room.shelf.stops = content
        assert room.listen(0.5) is None
        assert room.ears.stops == (STOP,)
    room.shelf.remove()
    room.listen(0.1)
    assert room.ears.stops == ()


def test_stops_that_were_kept_are_known_from_the_beginning() -> None:
    shelf = Shelf(STOP)
    judge = Judge(DriveSettings(), 4.08, 100.0)
    assert Overhearing(FakeNode(), DriveSettings(), judge, shelf).stops == (STOP,)


def test_a_stop_that_was_kept_and_is_gone_at_the_first_look_is_over() -> None:
    shelf = Shelf(STOP)
    ears = Overhearing(FakeNode(), DriveSettings(), Judge(DriveSettings(), 4.08, 100.0), shelf)
    shelf.remove()
    ears.listen(100.02)
    assert ears.stops == ()


def test_another_stop_is_not_released_by_the_name_of_the_first(room: Room) -> None:
    other = Stop(engaged=True, id=6, by="bob", why="")
    for said in (STOP, other, RELEASE):
        room.hear("stop", said)
    assert room.listen(1.0) == other


def test_a_stop_said_by_hand_counts_each_time(room: Room) -> None:
    """Its id is 0, as somebody types it who knows of none."""
    by_hand, release = (Stop(engaged=on, id=0, by="", why="") for on in (True, False))
    room.hear("stop", by_hand)
    room.shelf.add(by_hand)
    room.listen()
    room.shelf.remove()
    room.hear("stop", release)
    room.listen()
    room.hear("stop", by_hand)
    assert room.listen(1.0) == by_hand


def test_after_a_stop_only_what_begins_anew_is_allowed(room: Room) -> None:
    room.shelf.add(STOP)
    room.push()
    room.listen(GRACE + 0.1)
    room.push()
    room.listen()
    assert not room.judge.allowed(room.now)
    room.shelf.remove()
    room.listen(GRACE + 0.1)
    room.push()
    room.listen()
    assert not room.judge.allowed(room.now)
    room.now += 1.0  # and with it the prover's silence
    room.push()
    room.listen()
    assert room.judge.allowed(room.now)


def test_it_is_deaf_half_a_second_after_the_last_beat_of_the_epoch(room: Room) -> None:
    assert not room.ears.hears(1, room.now)
    room.beat(2)
    assert not room.ears.hears(1, room.now)
    room.beat(1)
    assert room.ears.hears(1, room.now)
    assert room.ears.hears(1, room.now + DEAF_AFTER - 0.01)
    room.beat(2)
    assert not room.ears.hears(1, room.now + DEAF_AFTER + 0.01)


def test_an_actuator_that_has_not_reported_is_not_heard(room: Room) -> None:
    room.beat(1)
    assert not room.ears.hears(None, room.now)
