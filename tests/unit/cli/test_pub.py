import argparse
import re
from types import SimpleNamespace
from typing import Any

import pytest

from zteleop.bus.names import Name
from zteleop.bus.presence import Endpoint
from zteleop.cli import _options, pub
from zteleop.control.gate import Refusal
from zteleop.control.resume import Resume
from zteleop.errors import BusError
from zteleop.messages import (
    DriveStatus,
    Header,
    Message,
    Refusals,
    Refused,
    Twist,
    TwistStamped,
    Vector3,
    Vehicle,
)
from zteleop.testing import Clock, FakeNode, Said

FORWARD = Twist.planar(0.5)


def does(state: Any, why: str = "", operator: str = "") -> DriveStatus:
    status = DriveStatus.zero()
    status.state, status.why, status.operator = state, why, operator
    return status


def say(
    message: Message,
    times: int | None,
    ticks: int,
    said: Said | None = None,
    node: FakeNode | None = None,
    resume: Resume | None = None,
    status: DriveStatus | None = None,
) -> list[Any]:
    """Return what is said within so many ticks, ended by Ctrl-C, to a robot that obeys it, or is so."""
    node, said = node or FakeNode(), said or Said("cmd_vel", "ff")

    def spin(seconds: float | None = None) -> None:
        heed, *_ = node.inboxes["drive_status"].handlers
        heed(SimpleNamespace(message=status or does("driving", "keyboard drives", "ff")))
        if seconds is not None:
            node.stayed = seconds
            node.loop.run(0.1)
            return
        for _ in range(ticks):
            node.loop.run(0.1)
            if node.stopped:
                return
        raise KeyboardInterrupt

    node.spin = spin
    try:
        pub._say(node, said, lambda: message, 10.0, times, resume, 0.5, pub.Outcome("pub", node, said))
    except KeyboardInterrupt:
        assert times is None
    return said.messages


@pytest.mark.parametrize(
    ("topic", "robot", "command"),
    [
        ("cmd_vel", None, True),
        ("cmd_vel/joystick", "abe", True),
        ("abe/pwm", None, True),
        ("/abe/cmd_vel_stamped", "bob", True),
        ("odom", None, False),
        ("abe/photo", None, False),
        ("No Name/photo", None, False),
    ],
)
def test_only_what_is_no_command_may_wait_for_its_way(topic: str, robot: str | None, command: bool) -> None:
    assert pub._is_command(topic, robot) is command


@pytest.mark.parametrize("times", [1, 3])
def test_it_says_it_so_many_times(times: int, capsys: pytest.CaptureFixture[str]) -> None:
    assert say(FORWARD, times, 10) == [FORWARD] * times
    assert capsys.readouterr().out.startswith("publishing #1: Twist(linear=")


def test_ten_times_a_second_for_a_second_are_ten() -> None:
    node, said = FakeNode(), Said("cmd_vel", "ff")
    node.spin = lambda seconds=None: [node.loop.run(0.1) for _ in range(12)]
    pub._say(node, said, lambda: FORWARD, 10.0, None, None, 0.5, None, lasts=1.0)  # type: ignore[arg-type]
    assert (said.messages, said.lets_go, node.stopped) == ([FORWARD] * 10, 1, False)


def test_what_is_repeated_is_let_go_at_the_end() -> None:
    said = Said("cmd_vel", "ff")
    say(FORWARD, None, 5, said)
    assert (said.messages, said.lets_go) == ([FORWARD] * 5, 1)


def test_what_is_said_so_many_times_stays_said_for_as_long_as_it_is_obeyed() -> None:
    said, node = Said("cmd_vel", "ff"), FakeNode()
    say(FORWARD, 3, 10, said, node)
    assert (said.messages, said.lets_go, node.stayed) == ([FORWARD] * 3, 0, 0.5)


@pytest.mark.parametrize(
    ("asked", "slowed", "words"),
    [
        (Twist.planar(0.5), "", ""),
        (Twist.planar(-50.0, 1.0), "", ""),  # what it cannot, its publisher says
        (Twist.planar(0.6), "limits.speed is set to 0.5 m/s", ""),  # so it does of what it may not
        (
            Twist.planar(0.6),
            "limits.turn is 0.5 rad/s",
            "0.6 m/s are asked for, and it makes 0.5 at most: limits.turn is 0.5 rad/s\n",
        ),
        (
            Twist.planar(-50.0),
            "nav may drive no faster here",
            "50 m/s are asked for, and it makes 0.5 at most: nav may drive no faster here\n",
        ),
    ],
)
def test_who_asks_for_more_than_the_robot_makes_is_told_once(
    capsys: pytest.CaptureFixture[str], car: Vehicle, asked: Twist, slowed: str, words: str
) -> None:
    node, status = FakeNode(), does("driving", "", "ff")
    node.membership.heard().vehicle = car
    status.wanted, status.max_speed, status.slowed = asked, 0.5, slowed
    outcome = pub.Outcome("pub", node, Said("cmd_vel", "ff"))  # type: ignore[arg-type]
    hear = node.inboxes["drive_status"].handlers[0]
    others = does("driving", "", "aa")
    others.wanted = Twist.planar(70.0)
    for said in (others, status, status, status):
        hear(SimpleNamespace(message=said))
    told = capsys.readouterr().err
    assert told.startswith(f"zteleop pub: {words}" if words else "")
    assert told.count("\n") == bool(words)
    outcome.check()


def test_who_is_ended_leaves_at_once() -> None:
    node = FakeNode()
    say(FORWARD, None, 5, node=node)
    assert not hasattr(node, "stayed")


@pytest.mark.parametrize(("released", "lets_go"), [(4, 1), (5, 0)], ids=["restarted", "stopped meanwhile"])
def test_it_begins_anew_as_it_resumes(clock: Clock, released: int, lets_go: int) -> None:
    node, said, resume = FakeNode(), Said("cmd_vel", "ff"), Resume("ff")
    resume.heed(status(4))
    refused = Refused("ff", "program", Refusal.EARLIER_START, "", 0.6)
    node.membership.robot.refusals = Refusals([refused], "", released)
    say(FORWARD, 3, 3, said, node, resume)
    assert said.lets_go == lets_go
    assert said.messages == [FORWARD] * 3


def test_it_follows_what_the_robot_does_to_know_of_a_stop(clock: Clock) -> None:
    node, resume = FakeNode(), Resume("ff")
    say(FORWARD, 1, 1, None, node, resume)
    refused = Refused("ff", "program", Refusal.EARLIER_START, "", 0.6)
    may = []
    for number, operator in ((4, "ff"), (5, "")):
        node.inboxes["drive_status"].handler(SimpleNamespace(message=status(number, operator)))
        clock.pass_by(10.0)
        may.append(resume.may(Refusals([refused], "", 4), clock.time))
    assert may == [True, False]


def status(released: int, operator: str = "ff") -> DriveStatus:
    status = DriveStatus.zero()
    status.state, status.released, status.operator = "driving", released, operator
    return status


@pytest.mark.parametrize(("text", "rate"), [("20", 20.0), ("0.5", 0.5), ("1000", 1000.0)])
def test_a_rate_is_a_number(text: str, rate: float) -> None:
    assert _options.rate_hz(text) == rate


@pytest.mark.parametrize("text", ["0", "-1", "nan", "inf", "1001"])
def test_a_rate_out_of_range_is_refused(text: str) -> None:
    with pytest.raises(argparse.ArgumentTypeError, match="a rate is more than 0 and at most 1000 Hz"):
        _options.rate_hz(text)


@pytest.mark.parametrize("times", ["0", "-3"])
def test_a_count_that_never_comes_is_refused(times: str, capsys: pytest.CaptureFixture[str]) -> None:
    parser = argparse.ArgumentParser()
    pub.add_arguments(parser)
    with pytest.raises(SystemExit):
        parser.parse_args(["archangel/cmd_vel", "Twist", "-t", times])


@pytest.mark.parametrize(
    ("status", "words"),
    [
        (does("stopped", "stopped by ann"), "nothing of it was obeyed: stopped: stopped by ann"),
        (
            does("driving", "keyboard 1234 drives", "aa"),
            "nothing of it was obeyed: driving: keyboard 1234 drives",
        ),
    ],
)
def test_what_a_robot_obeys_nothing_of_is_an_error(status: DriveStatus, words: str) -> None:
    with pytest.raises(BusError, match=words):
        say(FORWARD, 1, 5, status=status)


def test_the_robots_own_words_come_first() -> None:
    said = Said("cmd_vel", "ff")
    said.refused = "it was moving before the stop was released"
    with pytest.raises(BusError, match="nothing of it was obeyed: it was moving before"):
        say(FORWARD, 1, 5, said, status=does("idle"))


def test_whoever_asks_for_rest_need_not_be_obeyed() -> None:
    assert say(Twist.planar(), 1, 5, status=does("stopped")) == [Twist.planar()]


def ends(*told: tuple[str, str, str, str]) -> list[Endpoint]:
    return [Endpoint("abe", kind, node, "pi-7", kind_, topic) for kind, node, topic, kind_ in told]


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("cmd_vel/program", ""),
        ("cmd_vel", ""),
        ("pwm/nav", ""),
        ("cmd_vel/keybord", "robot abe has no source 'keybord'; did you mean keyboard"),
        (
            "cmd_vel/nav",
            r"no source 'nav'; known: keyboard, program; \[drive.sources.nav\] in its config.toml adds",
        ),
    ],
)
def test_a_source_that_the_robot_does_not_hear_is_said_to_be_none(
    monkeypatch: pytest.MonkeyPatch, path: str, words: str
) -> None:
    there = ends(
        ("sub", "actuator", "cmd_vel/keyboard", "any"),
        ("sub", "actuator", "cmd_vel/program", "any"),
        ("sub", "echo", "cmd_vel/**", "any"),
        ("pub", "nose", "cmd_vel/nav", "any"),
    )
    monkeypatch.setattr(pub.presence, "endpoints", lambda session: there)
    said = pub.presence.unknown_source(FakeNode().membership.session, Name("abe", path))
    assert re.search(words, said) if words else not said


@pytest.mark.parametrize("stamped", [False, True])
def test_a_motion_that_no_wheels_make_is_a_failure(stamped: bool) -> None:
    sideways = Twist(Vector3(0.0, 0.2, 0.0), Vector3(1.0, 0.0, 0.0))
    message = TwistStamped(Header.zero(), sideways) if stamped else sideways
    with pytest.raises(
        BusError, match=r"^nothing of it moves a robot: a robot on wheels obeys linear\.x and"
    ):
        say(message, 3, 10)
    assert say(Twist.zero(), 3, 10) == 3 * [Twist.zero()], "rest is meant, and had"


def test_one_motion_that_no_wheels_make_among_others_is_no_failure() -> None:
    node = FakeNode()
    outcome = pub.Outcome("pub", node, Said("cmd_vel", "ff"))  # type: ignore[arg-type]
    for message in (Twist(Vector3(0.0, 0.2, 0.0), Vector3.zero()), FORWARD):
        outcome.note(message)
    node.inboxes["drive_status"].handlers[0](SimpleNamespace(message=does("driving", "", "ff")))
    outcome.check()
