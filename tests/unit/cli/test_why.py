import argparse
import sys
from collections.abc import Callable
from contextlib import nullcontext
from datetime import UTC, datetime
from types import SimpleNamespace
from typing import Any

import pytest
from msgspec.structs import replace

from zteleop.bus import presence
from zteleop.bus.names import resolve
from zteleop.cli import why
from zteleop.cli.why import answer, state_of
from zteleop.errors import BusError
from zteleop.messages import DriveStatus, Layer, Odometry, Twist, WatchdogStatus, Why
from zteleop.testing import FakeNode


class Node(FakeNode):
    """One that hears, at its first glance, what the test put into its inboxes."""

    def until(self, look: Callable[[], Any], seconds: float) -> Any:
        self.patience = seconds
        for topic, message in self.says.items():
            self.inboxes[topic].waiting.append(message)
        return look()


def node(**says: Any) -> Node:
    node = Node()
    node.membership.until = node.until
    node.says = says
    return node


def dog(**changes: Any) -> WatchdogStatus:
    values = {
        "state": "watching",
        "why": "the actuator steps",
        "silence": 0.0123,
        "moving": False,
        "allowed": False,
        "commands": 7,
        "restarts": 0,
    }
    return WatchdogStatus(**values | changes)


STATUS = DriveStatus.zero()
STATUS.state, STATUS.why = "driving", "keyboard drives"
LAYERS = Why([Layer("operator", "keyboard 00ff operates"), Layer("limiter", "passes it on as asked")])


def test_a_line_for_the_robot_and_one_for_each_layer(monkeypatch: pytest.MonkeyPatch) -> None:
    today = datetime(2026, 11, 28, 21, 40, 5, tzinfo=UTC)
    monkeypatch.setattr(why, "datetime", SimpleNamespace(now=lambda zone: today))
    assert answer(node(drive_status=STATUS, why=LAYERS, watchdog=dog())).splitlines() == [
        "archangel is driving: keyboard drives",
        "  operator  keyboard 00ff operates",
        "  limiter   passes it on as asked",
        "  watchdog  watching: the actuator steps, within the last 50 ms; sees pulses of rest, "
        "and hears no command that allows motion now",
        f"  odom      {why.UNPLACED}",
        "  at        2026-11-28 21:40:05 UTC",
    ]


def test_where_somebody_says_where_it_is_that_is_not_missed() -> None:
    desk = node(drive_status=STATUS, why=LAYERS, watchdog=dog())
    key = presence.endpoint_key(resolve("odom", "archangel"), "pub", "sim", ())
    desk.membership.session.tokens = lambda selector: {key}
    assert "nobody says where it is" not in answer(desk)
    assert "nobody says where it is" not in answer(node(watchdog=dog())), "which is not the matter there"


def test_a_sender_that_is_spoken_of_is_told_by_its_node_and_process() -> None:
    desk = node(drive_status=STATUS, why=LAYERS, watchdog=dog())
    keys = {f"robot/archangel/live/sender/{sender}/desk/mac-7" for sender in ("ff", "a00ff", "10ff", "7")}
    desk.membership.session.tokens = lambda selector: keys
    lines = answer(desk).splitlines()
    assert lines[-3:-1] == ["  who       keyboard 00ff is desk, process 7 on mac"] * 2, (
        "whose last digits are the same"
    )


def test_a_robot_whose_actuator_is_gone_is_told_by_its_watchdog() -> None:
    lines = answer(node(watchdog=dog(state="resting", why="the actuator is gone: it ended"))).splitlines()
    assert lines[0] == "archangel: no actuator heard"
    assert lines[1].startswith("  watchdog  resting: the actuator is gone: it ended; sees ")


def test_a_robot_whose_watchdog_is_not_heard_says_so() -> None:
    assert answer(node(drive_status=STATUS)).splitlines()[-3] == "  watchdog  is not heard"


def test_nobody_there_is_an_error_in_words_that_names_who_is_and_is_told_sooner(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    silent = node()
    monkeypatch.setattr(why.presence, "robots", lambda session: ["zoe"])
    words = r"no actuator of archangel is heard within 2 s; is it on\? if it failed, zteleop blackbox"
    with pytest.raises(BusError, match=words):
        answer(silent)
    assert silent.patience == why.HEARD_WITHIN - why.TELL_AFTER
    assert capsys.readouterr().err == "zteleop why: waits for archangel; heard here: zoe\n"


@pytest.mark.parametrize("is_terminal", [True, False])
def test_where_nobody_answers_a_file_says_so_as_well(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], is_terminal: bool
) -> None:
    def join(verb: str, settings: Any) -> FakeNode:
        return node()

    monkeypatch.setattr(why.presence, "robots", lambda session: ["archangle"])
    monkeypatch.setattr(why._options, "join", join)
    monkeypatch.setattr(why._options, "load_anyhow", lambda arguments: None)
    monkeypatch.setattr(sys.stdout, "isatty", lambda: is_terminal)
    with pytest.raises(BusError, match=r"is it on\? if it failed, "):
        why.run(argparse.Namespace())
    assert bool(capsys.readouterr().out) is not is_terminal


@pytest.mark.parametrize(
    ("status", "words"),
    [
        (dog(moving=True, allowed=True), "sees pulses off neutral, and hears commands that allow motion"),
        (dog(moving=True), "sees pulses off neutral, and hears no command that allows motion now"),
        (dog(allowed=True), "sees pulses of rest, and hears commands that it would let pass"),
        (dog(restarts=3), "no command that allows motion now; 3 restarts"),
        (dog(restarts=1), "no command that allows motion now; 1 restart"),
        (dog(state="starting", why="the actuator starts"), "starting: the actuator starts; sees"),
    ],
)
def test_what_a_watchdog_sees_in_a_line(status: WatchdogStatus, words: str) -> None:
    line = state_of(status)
    assert words in line
    assert "1 restarts" not in line
    assert "\n" not in line


def test_the_verb_prints_it_escaped(monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    evil = Why([Layer("operator", "\x1b[2Jkeyboard")])
    monkeypatch.setattr(why._options, "load_anyhow", lambda arguments: None)
    monkeypatch.setattr(
        why._options, "join", lambda name, settings: nullcontext(node(drive_status=STATUS, why=evil))
    )
    why.run(None)
    out = capsys.readouterr().out
    assert "\x1b" not in out
    assert out.count("\n") == 5


def test_a_stranger_adds_no_line_of_his_own() -> None:
    evil = Why([Layer("operator", "nobody\n  watchdog  watching")])
    assert len(answer(node(drive_status=STATUS, why=evil)).splitlines()) == 5


@pytest.mark.parametrize(
    ("state", "asked", "moves", "told"),
    [
        ("driving", 0.3, 0.0, True),
        ("driving", 0.3, 0.3, False),
        ("driving", 0.0, 0.0, False),
        ("idle", 0.3, 0.0, False),
    ],
)
def test_a_robot_that_stands_where_its_wheels_turn_is_said_to(
    state: str, asked: float, moves: float, told: bool
) -> None:
    status, odom = DriveStatus.zero(), Odometry.zero()
    status.state, status.why = state, "keyboard drives"  # type: ignore[assignment]
    status.applied, odom.twist.twist = Twist.planar(asked), Twist.planar(moves)
    desk = node(drive_status=status, why=LAYERS, watchdog=dog(), odom=odom)
    key = presence.endpoint_key(resolve("odom", "archangel"), "pub", "sim", ())
    desk.membership.session.tokens = lambda selector: {key}
    assert (why.STANDS in answer(desk)) is told


def turns_in_vain(**about: Any) -> DriveStatus:
    status = DriveStatus.zero()
    status.state, status.why, status.wanted = "driving", "program drives", Twist.planar(0.0, 0.5)
    return replace(status, **about)


def test_a_robot_that_is_driven_and_stands_says_why_in_its_first_line() -> None:
    words = "makes it +0.00 m/s +0.00 rad/s: a car that stands only turns its wheels"
    layers = Why([Layer("limiter", words)])
    first = answer(node(drive_status=turns_in_vain(), why=layers, watchdog=dog())).splitlines()[0]
    assert first == f"archangel is driving: program drives, and it stands: the limiter {words}"
    for status in (
        turns_in_vain(applied=Twist.planar(0.1)),
        turns_in_vain(wanted=Twist.planar()),
        turns_in_vain(state="idle"),
    ):
        assert "stands" not in answer(node(drive_status=status, why=layers, watchdog=dog())).splitlines()[0]


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("program 00ff has been silent for 1 s", True),
        ("program 00ff has not heard the robot for 1 s", False),
    ],
)
def test_a_silence_may_be_a_link_or_a_program_that_speaks_seldom(words: str, told: bool) -> None:
    status = replace(DriveStatus.zero(), state="link lost", why=words)
    lines = answer(node(drive_status=status, why=LAYERS, watchdog=dog())).splitlines()
    assert lines[0] == f"archangel has lost touch with its driver: {words}"
    assert (f"  link      {why.SELDOM}" in lines) is told
