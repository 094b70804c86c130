from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from zteleop import config
from zteleop.bus import presence
from zteleop.bus.lane.wire import Answered
from zteleop.cli import _options
from zteleop.cli import stop as verb
from zteleop.cli._run import run_verb
from zteleop.control.stop import Latch
from zteleop.errors import BusError
from zteleop.messages import DriveStatus, Stop
from zteleop.nodes.stop_request import REPEAT
from zteleop.testing import Clock, FakeNode, Inbox, Said

GLANCE = 0.01


class Robot(FakeNode):
    """A node whose `until` lets a robot answer, when there is one."""

    calm = ("idle", "nobody drives")
    """State and reason of a robot that is not stopped."""

    def __init__(self, clock: Clock, latch: Latch | None) -> None:
        super().__init__(clock=clock)
        self.clock, self.latch = clock, latch
        self.membership.until = self.until
        self.ears: list[Inbox] = []

    def subscription(self, topic: str, types: object, handler: Any = None) -> Inbox:
        self.ears.append(Inbox(*filter(None, [handler])))
        return self.ears[-1]

    def until(self, look: Callable[[], Any], seconds: float) -> Any:
        give_up = self.clock.time + seconds
        while not (found := look()) and self.clock.time < give_up:
            self.clock.pass_by(GLANCE)
            self.answer()
        return found

    def answer(self) -> None:
        if self.latch is None:
            return
        for said in self.said.get(f"/{self.robot}/stop", Said("stop")).take():
            self.latch.obey(said)
        status = DriveStatus.zero()
        status.stops, status.confirmed = list(self.latch.stops), "read"
        status.state, status.why = ("stopped", "a stop") if status.stops else self.calm
        for inbox in self.ears:
            inbox.waiting.append(status)
            if inbox.handlers:
                inbox.handler(SimpleNamespace(message=status, at=self.clock.time))

    def __enter__(self) -> "Robot":
        return self

    def __exit__(self, *exc: object) -> None:
        pass


class Lane:
    """The lane without a network: what was said on it, and what comes back."""

    def __init__(self, settings: object = None) -> None:
        self.said: list[tuple[str, Stop]] = []
        self.waiting: list[Answered] = []

    def __enter__(self) -> "Lane":
        return self

    def __exit__(self, *exc: object) -> None:
        pass

    def say(self, robot: str, stop: Stop) -> None:
        self.said.append((robot, stop))

    def answers(self) -> list[Answered]:
        answers, self.waiting = self.waiting, []
        return answers


class Stopped(Lane):
    """A robot that answers on the lane, and on nothing else."""

    def say(self, robot: str, stop: Stop) -> None:
        super().say(robot, stop)
        self.waiting.append(Answered(robot, stop.id, held=True, confirmed="read"))


Type = Callable[..., tuple[int, str, str]]


OWN = "zteleop: no robot is named, and none is heard; archangel is meant, as this machine's own is called\n"


@pytest.fixture
def latch() -> Latch:
    return Latch()


@pytest.fixture
def heard() -> list[str]:
    """Whoever is there, where the robot that is meant is not."""
    return []


@pytest.fixture
def typed(
    clock: Clock, heard: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Type:
    """Type `zteleop stop` beside a robot, or beside none."""
    monkeypatch.setattr(verb, "person", lambda: "ann@desk")
    monkeypatch.setattr(verb, "Call", Lane)
    monkeypatch.setattr(config, "own_name", lambda: "archangel")

    def type_(latch: Latch | None, *arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(_options, "join_for_any", lambda name, settings, settle: Robot(clock, latch))
        monkeypatch.setattr(presence, "robots", lambda session: ["archangel"] if latch else heard)
        code = run_verb("stop", "stop a robot", list(arguments))
        return code, *capsys.readouterr()

    return type_


def test_a_stop_says_how_to_release_it_and_why_it_goes_on(latch: Latch, typed: Type) -> None:
    assert typed(latch, "archangel", "--why", "a cat") == (
        0,
        "archangel is stopped (neutral read back from the chip within 10 ms); "
        "zteleop stop --release archangel lets it drive again, from neutral\n"
        "goes on saying so until 3 s are over, to whoever comes late; the stop outlasts this\n",
        "",
    )
    assert [(stop.by, stop.why) for stop in latch.stops] == [("ann@desk", "a cat")]


def test_a_release_is_one_line(latch: Latch, typed: Type) -> None:
    typed(latch)
    assert typed(latch, "--release") == (
        0,
        "archangel may drive again, from neutral (acknowledged within 10 ms)\n",
        "",
    )
    assert latch.stops == ()


def test_a_stop_is_said_for_three_seconds_although_it_is_answered(
    latch: Latch, typed: Type, clock: Clock
) -> None:
    before = clock.time
    typed(latch, "archangel")
    assert REPEAT <= clock.time - before < REPEAT + 0.1


def test_the_stop_of_another_is_released_only_by_who_says_all(latch: Latch, typed: Type) -> None:
    latch.obey(Stop(True, 7, "bob@sofa", "a child"))
    code, out, error = typed(latch, "--release", "archangel")
    assert (code, out) == (1, "")
    assert error == (
        "zteleop stop: archangel is stopped by bob@sofa (a child); each releases their own, "
        "zteleop stop --release --all archangel everybody's\n"
    )
    assert typed(latch, "--release", "--all", "archangel")[0] == 0
    assert latch.stops == ()


def test_a_robot_nobody_has_is_told_with_those_there_are(typed: Type, heard: list[str]) -> None:
    heard += ["archangel", "michael"]
    code, _, error = typed(None, "gabriel")
    assert code == 1
    words, *rest = error.splitlines()
    assert words == "gabriel does not answer so far, and is asked on; heard here: archangel, michael"
    assert rest[-1].endswith("or run zteleop neutral --robot gabriel on it")


def test_who_forgot_the_dashes_of_release_is_told_of_them(typed: Type, heard: list[str]) -> None:
    heard += ["archangel"]
    first = typed(None, "relase")[2].splitlines()[0]
    assert first.endswith("heard here: archangel; zteleop stop --release is what lets a robot drive again")


@pytest.mark.parametrize(
    ("words", "meant"),
    [
        ((), ["archangel", "michael"]),
        (("--all",), ["archangel", "michael"]),
        (("michael", "--all"), ["archangel", "michael"]),
        (("michael",), ["michael"]),
        (("gabriel", "--all"), ["archangel", "gabriel", "michael"]),
    ],
)
def test_of_several_robots_that_nobody_named_all_are_stopped_where_nobody_can_answer(
    typed: Type, heard: list[str], monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...], meant: list[str]
) -> None:
    heard += ["archangel", "michael"]
    asked: list[list[str]] = []
    monkeypatch.setattr(verb.Stops, "finish", lambda stops, node: asked.append(sorted(stops._asked)) or 0)
    assert typed(None, *words)[0] == 0
    assert asked == [meant]


@pytest.mark.parametrize(
    ("typed_answer", "meant"),
    [("", ["archangel", "michael"]), ("michael", ["michael"]), ("?", ["archangel", "michael"])],
)
def test_somebody_at_a_terminal_is_asked_and_all_is_the_first_choice(
    monkeypatch: pytest.MonkeyPatch, typed_answer: str, meant: list[str]
) -> None:
    for stream in (verb.sys.stdin, verb.sys.stdout):
        monkeypatch.setattr(stream, "isatty", lambda: True, raising=False)
    monkeypatch.setattr("builtins.input", lambda prompt: typed_answer)
    assert verb._ask(["archangel", "michael"]) == meant


def test_a_release_of_what_is_not_stopped_is_done_already(latch: Latch, typed: Type) -> None:
    assert typed(latch, "--release") == (0, "archangel is not stopped\n", "")


def test_a_stop_that_nobody_acknowledges_is_an_error_that_says_what_to_do(typed: Type) -> None:
    assert typed(None) == (
        1,
        "",
        OWN + "archangel does not answer so far, and is asked on; no actuator is heard here\n"
        "zteleop stop: archangel has not acknowledged the stop within 2 s: "
        "cut its power, or run zteleop neutral --robot archangel on it\n",
    )


def test_a_release_of_a_robot_that_is_not_heard_is_an_error(typed: Type) -> None:
    code, out, error = typed(None, "--release")
    assert (code, out) == (1, "")
    assert error == (
        f"{OWN}zteleop stop: waits for archangel; no actuator is heard here\n"
        "zteleop stop: archangel is not heard, so nothing is released; no actuator is heard here\n"
    )


def test_the_first_word_leaves_before_anything_is_waited_for(clock: Clock) -> None:
    node, lane = Robot(clock, None), Lane()
    order: list[str] = []
    whys: list[str] = []
    node.publisher = lambda topic, types: SimpleNamespace(
        matched=False, publish=lambda said: order.append(f"said {topic}")
    )
    node.subscription = lambda *arguments: order.append("subscribed")

    def until(look: Callable[[], object], seconds: float) -> object:
        order.append("waited")
        raise BusError("enough")

    node.membership.until = until
    lane.say = lambda robot, said: order.append(f"lane {robot}") or whys.append(said.why)
    stops = verb.Stops(lane, "")
    stops.engage(["a", "b"])
    assert order == ["lane a", "lane b"]
    assert whys == ["at a shell"] * 2, "where nobody says why, it is told which of somebody's ways it was"
    with pytest.raises(BusError, match="enough"):
        stops.finish(node)
    said = ["lane a", "said /a/stop", "lane b", "said /b/stop"]
    assert order[2:] == [*said, "subscribed", "subscribed", "waited"]


def test_a_robot_that_answers_without_the_bus_is_stopped_and_that_is_said(
    typed: Type, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(verb, "Call", Stopped)
    code, out, error = typed(None, "archangel")
    assert (code, error) == (0, "archangel answered by datagram; on the bus it is not heard\n")
    assert out.startswith("archangel is stopped (neutral read back from the chip within ")


@pytest.mark.parametrize(
    ("lane", "code", "words"),
    [
        (Stopped, 0, "zteleop stop: warning: no router found; it went out as datagrams alone\n"),
        (Lane, 1, "or run zteleop neutral --robot archangel on it\nzteleop stop: no router found\n"),
    ],
)
def test_without_a_bus_a_stop_goes_out_all_the_same(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    clock: Clock,
    lane: type[Lane],
    code: int,
    words: str,
) -> None:
    def fail(name: str, settings: object, settle: bool) -> None:
        raise BusError("no router found")

    monkeypatch.setattr(verb, "Call", lane)
    monkeypatch.setattr(verb.time, "sleep", clock.pass_by)
    monkeypatch.setattr(_options, "join_for_any", fail)
    assert run_verb("stop", "stop a robot", ["archangel"]) == code
    out, error = capsys.readouterr()
    assert error.endswith(words)
    assert ("archangel is stopped" in out) is (code == 0)


def test_what_a_stranger_says_cannot_steer_the_terminal(
    latch: Latch, typed: Type, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Robot, "calm", ("fault", "\x1b[2Jevil"))
    typed(latch)
    code, out, _ = typed(latch, "--release")
    assert code == 0
    assert out == "the stop of archangel is over, but it is kept at rest: \\u001b[2Jevil\n"


def test_what_one_word_stopped_one_word_releases(
    clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    answers = {"abe": "abe is released", "bob": "bob is not stopped", "zoe": BusError("zoe is not heard")}

    def release(node: object, robot: str, everybodys: bool) -> str:
        answer = answers[robot]
        if isinstance(answer, BusError):
            raise answer
        return answer

    monkeypatch.setattr(verb, "release", release)
    node = Robot(clock, None)
    assert verb.release_each(node, ["abe", "bob"], False) == 0  # type: ignore[arg-type]
    assert capsys.readouterr() == ("abe is released\nbob is not stopped\n", "")
    assert verb.release_each(node, ["zoe", "abe"], False) == 1  # type: ignore[arg-type]
    assert capsys.readouterr() == ("abe is released\n", "zteleop stop: zoe is not heard\n")
    with pytest.raises(BusError):
        verb.release_each(node, ["zoe"], False)  # type: ignore[arg-type]


def test_a_release_that_names_nobody_is_for_all_that_are_heard(
    latch: Latch, typed: Type, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []
    monkeypatch.setattr(verb, "release", lambda node, robot, everybodys: asked.append(robot) or robot)
    typed(latch, "--release")
    monkeypatch.setattr(presence, "robots", lambda session: ["archangel", "michael"])
    monkeypatch.setattr(_options, "join_for_any", lambda name, settings, settle: Robot(Clock(), latch))
    assert run_verb("stop", "stop a robot", ["--release"]) == 0
    assert run_verb("stop", "stop a robot", ["--release", "michael"]) == 0
    assert asked == ["archangel", "archangel", "michael", "michael"]
