import getpass
from collections.abc import Iterator

import pytest

from zteleop.bus.lane.wire import Answered
from zteleop.bus.topics import TOPICS
from zteleop.control.stop import MERGED, Latch
from zteleop.messages import Confirmed, DriveStatus, Stop
from zteleop.nodes.stop_request import ACKNOWLEDGED_WITHIN, REPEAT, SETTLED, Stopping, person
from zteleop.testing import FakeNode, Said

TICK = 0.01


def idle() -> DriveStatus:
    return shows("idle")


def stopped(*stops: int, why: str = "", by: str = "the watchdog") -> DriveStatus:
    """Return what a robot shows that these stops keep at rest, each pressed by nobody's name."""
    return shows(
        "stopped", *(Stop(True, stop, f"{by}{n or ''}", "") for n, stop in enumerate(stops)), why=why
    )


def shows(
    state: str, *stops: Stop, why: str = "", unkept: str = "", confirmed: Confirmed = "read"
) -> DriveStatus:
    status = DriveStatus.zero()
    status.state, status.stops, status.why, status.unkept = state, list(stops), why, unkept
    status.confirmed = confirmed
    return status


class Asker:
    """Somebody who asks, and a clock that his test moves."""

    def __init__(self, node: FakeNode, by: str = "ann@desk") -> None:
        self.stopping = Stopping(node, by)
        self.said: Said = node.said["stop"]
        self.now = 100.0

    def engage(self, why: str = "") -> Stop:
        self.stopping.engage(self.now, why)
        return self.said.messages[-1]

    def release(self, status: DriveStatus | None) -> None:
        self.stopping.release(status, self.now)

    def heed(self, status: DriveStatus | None = None, after: float = TICK) -> bool:
        self.now += after
        return self.stopping.heed(status, self.now)

    def wait(self, seconds: float, status: DriveStatus | None = None) -> None:
        for _ in range(round(seconds / TICK)):
            self.heed(status)

    @property
    def outcome(self) -> tuple[str, str]:
        return self.stopping.state, self.stopping.words


@pytest.fixture
def asker(node: FakeNode) -> Asker:
    return Asker(node)


def test_who_never_asked_says_nothing(asker: Asker) -> None:
    asker.wait(3.0, idle())
    assert asker.said.messages == []
    assert asker.outcome == ("", "")
    assert not asker.stopping.unanswered


def test_a_stop_is_said_at_once_and_twenty_times_a_second_until_it_is_shown(asker: Asker) -> None:
    stop = asker.engage("a cat")
    assert asker.said.take() == [Stop(True, stop.id, "ann@desk", "a cat")]
    asker.wait(1.0, idle())
    assert asker.said.take() == [stop] * round(1.0 / TOPICS["stop"].every)
    assert asker.stopping.state == "pending"
    assert asker.heed(stopped(stop.id))
    assert asker.outcome == ("done", "archangel is stopped (neutral read back from the chip within 1010 ms)")


def test_what_was_answered_is_over_once_it_drives(asker: Asker) -> None:
    stop = asker.engage()
    asker.heed(shows("driving"))
    assert not asker.stopping.is_over, "it has yet to hear of it"
    asker.heed(stopped(stop.id))
    assert not asker.stopping.is_over
    asker.release(stopped(stop.id))
    asker.heed(idle())
    assert (asker.stopping.state, asker.stopping.is_over) == ("done", False)
    asker.heed(shows("driving"))
    assert asker.stopping.is_over


def test_a_stop_is_said_for_three_seconds_also_after_the_answer(asker: Asker) -> None:
    stop = asker.engage()
    asker.heed(stopped(stop.id))
    assert asker.stopping.state == "done"
    asker.wait(REPEAT - 0.1, stopped(stop.id))
    assert asker.stopping.repeats(asker.now)
    asker.wait(1.0, stopped(stop.id))
    assert not asker.stopping.repeats(asker.now)
    assert len(asker.said.take()) == pytest.approx(REPEAT / TOPICS["stop"].every, abs=2)


def test_a_stop_that_somebody_released_is_said_no_more(asker: Asker) -> None:
    stop = asker.engage()
    asker.heed(stopped(stop.id, 7))
    asker.heed(stopped(7))
    assert not asker.stopping.repeats(asker.now)
    asker.said.take()
    asker.wait(1.0, stopped(7))
    assert asker.said.messages == []


def test_a_stop_that_the_disk_does_not_take_is_told_to_who_presses(asker: Asker) -> None:
    stop = asker.engage()
    ours, full = Stop(True, stop.id, "ann@desk", ""), "/var/stop: No space left on device"
    assert not asker.heed(shows("stopped", ours, unkept="they are being written"))
    asker.wait(SETTLED, shows("stopped", ours, unkept=full))
    assert asker.stopping.state == "done"
    assert asker.stopping.words.endswith(f", but only until it restarts: {full}")


class Lane:
    """What was said as datagrams."""

    def __init__(self) -> None:
        self.said: list[tuple[str, Stop]] = []
        self.looks = 0

    def answers(self) -> Iterator[Answered]:
        self.looks += 1
        return (answer(stop) for _, stop in self.said)

    def say(self, robot: str, stop: Stop) -> None:
        self.said.append((robot, stop))


def answer(stop: Stop, confirmed: Confirmed = "read", **others: object) -> Answered:
    return Answered(**({"robot": "archangel", "id": stop.id, "held": True, "confirmed": confirmed} | others))


def test_a_stop_is_said_on_the_lane_before_there_is_a_bus_and_on_both_afterwards(node: FakeNode) -> None:
    lane = Lane()
    stopping = Stopping(None, "ann@desk", "archangel", lane)
    stopping.engage(100.0)
    stopping.heed(None, 100.0 + TOPICS["stop"].every)
    assert [robot for robot, _ in lane.said] == ["archangel"] * 2
    stopping.join(node)
    stopping.heed(None, 100.0 + TOPICS["stop"].every)
    assert node.said["/archangel/stop"].messages == [lane.said[0][1]]
    assert len(lane.said) == 3


def test_a_lane_of_its_own_is_listened_to_only_while_a_stop_is_asked_for() -> None:
    lane = Lane()
    stopping = Stopping(None, "ann@desk", "archangel", lane)
    stopping.listen(99.0)
    assert lane.looks == 0
    stopping.engage(100.0)
    stopping.listen(100.01)
    assert stopping.state == "done"


def test_whichever_answer_comes_first_is_believed(asker: Asker) -> None:
    stop = asker.engage()
    asker.now += TICK
    asker.stopping.hear_lane(answer(stop), asker.now)
    assert asker.outcome == ("done", "archangel is stopped (neutral read back from the chip within 10 ms)")
    asker.wait(1.0, idle())  # a status from before
    assert asker.stopping.repeats(asker.now)
    assert asker.stopping.state == "done"


@pytest.mark.parametrize("others", [{"robot": "michael"}, {"id": 7}, {"held": False}])
def test_what_answers_something_else_is_no_answer(asker: Asker, others: dict[str, object]) -> None:
    stop = asker.engage()
    asker.stopping.hear_lane(answer(stop, **others), asker.now)
    assert asker.stopping.state == "pending"


def test_an_answer_without_the_chips_word_is_a_failure_after_a_while_and_may_still_come_true(
    asker: Asker,
) -> None:
    stop = asker.engage()
    asker.stopping.hear_lane(answer(stop, ""), asker.now)
    assert asker.stopping.state == "pending"
    asker.now += SETTLED
    asker.stopping.hear_lane(answer(stop, "", trouble="nobody answers"), asker.now)
    assert asker.outcome == (
        "failed",
        "archangel heard the stop, not confirmed by the chip: cut its power (nobody answers)",
    )
    asker.stopping.hear_lane(answer(stop, "cut"), asker.now)
    assert asker.outcome == ("done", "archangel is stopped (its outputs are cut, late)")


def test_a_disk_has_a_moment_to_take_what_was_said_as_a_datagram(asker: Asker) -> None:
    stop = asker.engage()
    asker.stopping.hear_lane(answer(stop, unkept="it is being written"), asker.now)
    assert asker.stopping.state == "pending"
    asker.now += SETTLED
    asker.stopping.hear_lane(answer(stop, unkept="the disk is full"), asker.now)
    assert asker.stopping.words.endswith(", but only until it restarts: the disk is full")


def test_a_lost_acknowledgement_is_asked_for_again(asker: Asker) -> None:
    stop = asker.engage()
    asker.wait(1.5)
    assert not asker.heed(None)
    assert asker.heed(stopped(stop.id))
    assert asker.stopping.state == "done"


def test_each_press_has_an_id_of_its_own_that_is_never_nobodys(asker: Asker) -> None:
    ids = {asker.engage().id for _ in range(50)}
    assert len(ids) == 50
    assert all(0 < number < 2**53 for number in ids)


def test_a_stop_that_nobody_acknowledges_says_what_to_do(asker: Asker) -> None:
    asker.engage()
    asker.wait(ACKNOWLEDGED_WITHIN - 2 * TICK, idle())
    assert asker.stopping.state == "pending"
    asker.wait(0.05, idle())
    assert asker.outcome == (
        "failed",
        "archangel has not acknowledged the stop within 2 s: "
        "cut its power, or run zteleop neutral --robot archangel on it",
    )
    assert asker.stopping.unanswered
    assert asker.stopping.repeats(asker.now)
    asker.wait(REPEAT - ACKNOWLEDGED_WITHIN)
    asker.said.take()
    asker.wait(1.0)
    assert asker.said.messages == []


def test_an_answer_that_comes_late_is_an_answer(asker: Asker) -> None:
    stop = asker.engage()
    asker.wait(3.0)
    assert asker.stopping.unanswered
    asker.heed(stopped(stop.id + 1))
    assert asker.stopping.unanswered
    asker.heed(stopped(stop.id))
    assert not asker.stopping.unanswered
    assert asker.outcome == ("done", "archangel is stopped (neutral read back from the chip, late)")


HEARD = "archangel heard the stop, not confirmed by the chip: cut its power"


def test_outputs_that_are_cut_are_a_stop_as_well(asker: Asker) -> None:
    ours = asker.engage()
    assert asker.heed(shows("stopped", ours, confirmed="cut"))
    assert asker.outcome == ("done", "archangel is stopped (its outputs are cut within 10 ms)")


def test_a_stop_that_the_chip_does_not_confirm_is_no_stop(asker: Asker) -> None:
    ours = asker.engage()
    asker.wait(SETTLED, shows("stopped", ours, confirmed=""))
    assert asker.stopping.state == "pending"
    assert asker.heed(shows("fault", ours, why="nobody answers at 0x40", confirmed=""), 2 * TICK)
    assert asker.outcome == ("failed", f"{HEARD} (nobody answers at 0x40)")
    assert asker.stopping.unanswered
    assert asker.stopping.repeats(asker.now)
    asker.heed(shows("stopped", ours))
    assert asker.outcome == ("done", "archangel is stopped (neutral read back from the chip, late)")


def test_a_stop_that_was_heard_only_and_is_released_is_said_no_more(asker: Asker) -> None:
    ours = asker.engage()
    asker.wait(SETTLED + 2 * TICK, shows("stopped", ours, confirmed=""))
    assert asker.stopping.state == "failed"
    asker.heed(idle())
    assert not asker.stopping.repeats(asker.now)


def test_a_robot_that_falls_silent_before_its_chip_confirms_is_no_better(asker: Asker) -> None:
    ours = asker.engage()
    asker.heed(shows("stopped", ours, confirmed=""))
    asker.wait(ACKNOWLEDGED_WITHIN)
    assert asker.outcome == ("failed", f"{HEARD}, and is no longer heard")


def test_an_answer_that_comes_late_and_is_not_confirmed_says_that(asker: Asker) -> None:
    ours = asker.engage()
    asker.wait(ACKNOWLEDGED_WITHIN + TICK)
    asker.wait(SETTLED + 2 * TICK, shows("stopped", ours, confirmed=""))
    assert asker.outcome == ("failed", HEARD)


def test_anothers_stop_that_came_later_is_not_ours(asker: Asker) -> None:
    asker.heed(idle())
    stop = asker.engage()
    assert not asker.heed(stopped(7))
    assert asker.heed(stopped(7, stop.id))
    assert asker.stopping.state == "done"


@pytest.mark.parametrize("instead", [Stop(True, 9, "ann@desk", "pressed elsewhere"), MERGED])
def test_what_takes_the_place_of_ours_acknowledges_it(asker: Asker, instead: Stop) -> None:
    asker.heed(idle())
    asker.engage()
    assert asker.heed(shows("stopped", instead))
    assert asker.stopping.state == "done"


@pytest.mark.parametrize("by", ["bob@sofa", "ann@desk"])
@pytest.mark.parametrize("seen_before", [True, False])
def test_an_earlier_stop_of_anybody_is_no_acknowledgement_of_this_one(
    asker: Asker, seen_before: bool, by: str
) -> None:
    if seen_before:
        asker.heed(stopped(7, by=by))
    stop = asker.engage()
    asker.said.take()
    asker.wait(0.5, stopped(7, by=by))
    assert asker.stopping.state == "pending"
    assert asker.said.messages
    assert asker.heed(stopped(stop.id))
    assert asker.stopping.state == "done"


def test_a_robot_that_shows_but_an_earlier_stop_has_not_acknowledged_ours(asker: Asker) -> None:
    """It rests, but only until the other is released."""
    asker.engage()
    asker.wait(ACKNOWLEDGED_WITHIN + 0.1, stopped(7, by="bob"))
    assert asker.stopping.unanswered
    assert "within 2 s, and rests only by that of bob: cut its power" in asker.stopping.words


def test_a_robot_seen_stopped_long_ago_and_unheard_now_has_not_acknowledged(asker: Asker) -> None:
    asker.heed(stopped(7))
    asker.engage()
    asker.wait(3.0)
    assert asker.stopping.unanswered


def test_whoever_begins_to_listen_hears_it_at_once(asker: Asker) -> None:
    asker.said.matched = False
    stop = asker.engage()
    asker.heed(None, after=0.001)
    assert len(asker.said.take()) == 1
    asker.said.matched = True
    asker.heed(None, after=0.001)
    assert asker.said.take() == [stop]
    asker.heed(None, after=0.001)
    assert asker.said.take() == []


def test_a_release_names_the_stop_that_was_seen(asker: Asker) -> None:
    asker.release(stopped(7))
    asker.wait(1.0, stopped(7))
    assert set(map(repr, asker.said.take())) == {repr(Stop(False, 7, "ann@desk", ""))}
    assert asker.heed(idle())
    assert asker.outcome == ("done", "archangel may drive again, from neutral (acknowledged within 1010 ms)")


def test_a_stop_said_by_hand_has_no_number_and_can_be_released(asker: Asker) -> None:
    asker.release(stopped(0))
    assert asker.said.take() == [Stop(False, 0, "ann@desk", "")]
    asker.heed(idle())
    assert asker.stopping.state == "done"


def test_a_release_ends_ones_own_stop_and_says_whose_are_left(asker: Asker) -> None:
    mine, bobs = Stop(True, 7, "ann@desk", ""), Stop(True, 8, "bob@sofa", "a child")
    asker.release(shows("stopped", bobs, mine))
    assert asker.said.take() == [Stop(False, 7, "ann@desk", "")]
    assert asker.heed(shows("stopped", bobs))
    assert asker.outcome == (
        "done",
        "yours is released, but archangel is stopped by bob@sofa (a child); each releases their own, "
        "zteleop stop --release --all archangel everybody's",
    )


def test_a_stop_of_another_person_is_not_ones_own_to_release(asker: Asker) -> None:
    asker.release(shows("stopped", Stop(True, 8, "bob@sofa", ""), MERGED))
    assert asker.said.messages == []
    assert asker.outcome == (
        "failed",
        "archangel is stopped by bob@sofa and others (more than 64 people press stop); each releases their "
        "own, zteleop stop --release --all archangel everybody's",
    )
    assert not asker.stopping.unanswered


def test_everybodys_stops_are_released_by_who_says_so(asker: Asker) -> None:
    stops = [Stop(True, 7, "ann@desk", ""), Stop(True, 8, "bob@sofa", ""), MERGED]
    asker.stopping.release(shows("stopped", *stops), asker.now, everybodys=True)
    assert [said.id for said in asker.said.take()] == [stop.id for stop in stops]
    assert not asker.heed(shows("stopped", MERGED))
    assert asker.heed(idle())
    assert asker.stopping.state == "done"


def test_a_release_never_touches_a_newer_stop(asker: Asker) -> None:
    asker.release(stopped(7))
    asker.said.take()
    assert asker.heed(stopped(8, why="stopped by bob"))
    assert asker.outcome == ("failed", "archangel was stopped anew meanwhile: stopped by bob")
    asker.wait(1.0, stopped(8))
    assert asker.said.messages == []
    assert not asker.stopping.unanswered


@pytest.mark.parametrize("state", ["fault", "starting"])
def test_a_robot_released_and_kept_at_rest_by_something_else_says_so(asker: Asker, state: str) -> None:
    asker.release(stopped(7))
    asker.heed(shows(state, why="the chip is silent"))
    assert asker.outcome == (
        "done",
        "the stop of archangel is over, but it is kept at rest: the chip is silent",
    )


def test_a_release_that_nobody_acknowledges_leaves_it_stopped(asker: Asker) -> None:
    asker.release(stopped(7))
    asker.wait(3.0, stopped(7))
    assert asker.stopping.state == "failed"
    assert asker.stopping.words.endswith("the release within 2 s; take it as stopped, and try again")


def test_what_is_not_stopped_needs_no_release(asker: Asker) -> None:
    asker.release(shows("driving"))
    assert asker.outcome == ("done", "archangel is not stopped")
    assert asker.said.messages == []


def test_a_robot_that_is_not_heard_is_not_released(asker: Asker) -> None:
    asker.release(None)
    asker.wait(1.0, stopped(7))
    assert asker.outcome == ("failed", "archangel is not heard, so nothing is released")
    assert asker.said.messages == []


@pytest.mark.parametrize("status", [None, idle()])
def test_a_release_does_not_silence_a_stop_under_way(asker: Asker, status: DriveStatus | None) -> None:
    stop = asker.engage()
    asker.said.take()
    asker.release(status)
    asker.wait(0.2)
    assert set(map(repr, asker.said.take())) == {repr(stop)}


def test_a_stop_takes_the_place_of_a_release_under_way(asker: Asker) -> None:
    asker.release(stopped(7))
    stop = asker.engage()
    asker.said.take()
    asker.wait(0.2, idle())
    assert set(map(repr, asker.said.take())) == {repr(stop)}
    assert asker.stopping.state == "pending"


def test_a_release_asked_for_twice_gives_up_when_the_first_does(asker: Asker) -> None:
    asker.release(stopped(7))
    asker.wait(1.5, stopped(7))
    asker.release(stopped(7))
    asker.wait(0.6, stopped(7))
    assert asker.stopping.state == "failed"


def test_words_no_reader_would_take_do_not_cost_the_stop(node: FakeNode) -> None:
    stop = Asker(node, by="ann\udcff" + "n" * 300).engage("w" * 300 + "\ud800")
    assert len(stop.by) == len(stop.why) == 200
    (stop.by + stop.why).encode()


def test_it_talks_with_the_rule_of_the_robot(node: FakeNode) -> None:
    """Two people and a latch, over a network that loses every other word."""
    ann, bob = Asker(node, "ann@desk"), Asker(node, "bob@sofa")
    latch = Latch()

    def status() -> DriveStatus:
        return shows("stopped", *latch.stops) if latch.stops else idle()

    def talk(asker: Asker, other: Asker) -> None:
        for turn in range(300):
            for said in node.said["stop"].take()[turn % 2 :: 2]:
                latch.obey(said)
            other.heed(status())
            if asker.heed(status() if turn % 3 else None):
                return

    ann.engage()
    talk(ann, bob)
    bob.engage()
    talk(bob, ann)
    assert ann.stopping.state == bob.stopping.state == "done"
    for asker, other, left in ((bob, ann, 1), (ann, bob, 0)):
        asker.release(status())
        talk(asker, other)
        assert asker.stopping.state == "done"
        assert len(latch.stops) == left


def test_a_person_is_user_and_host(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(getpass, "getuser", lambda: "ann")
    monkeypatch.setattr("socket.gethostname", lambda: "desk")
    assert person() == "ann@desk"


def test_a_person_without_a_name_can_stop_too(monkeypatch: pytest.MonkeyPatch) -> None:
    def unknown() -> str:
        raise KeyError("uid not found")

    monkeypatch.setattr(getpass, "getuser", unknown)
    assert person().startswith("somebody@")


def test_a_robot_that_is_heard_again_and_not_stopped_ends_the_alarm(asker: Asker) -> None:
    """Else the screen says for ever to cut the power of a robot that drives."""
    asker.engage()
    asker.wait(REPEAT - 2 * TICK)
    asker.heed(idle())
    assert asker.stopping.unanswered, "it is still being said"
    asker.heed(idle(), 3 * TICK)
    assert not asker.stopping.unanswered
    words = "archangel is heard again, and not stopped: that stop never reached it; press once more"
    assert asker.outcome == ("failed", words)
    asker.heed(shows("stopped", Stop(True, 77, "ann@desk", "")))
    assert asker.outcome == ("failed", words), "another's stop is none of this one"
