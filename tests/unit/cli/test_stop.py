from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest
from unit.bus.fakes import Clock
from unit.nodes.fakes import Inbox, Node, Said

from zteleop.cli import options
from zteleop.cli import stop as verb
from zteleop.cli.run import run_verb
from zteleop.control.stop import Latch
from zteleop.messages import DriveStatus

GLANCE = 0.01


class Robot(Node):
    """A node whose `until` lets a robot answer, when there is one."""

    calm = ("idle", "nobody drives")
    """State and reason of a robot that is not stopped."""

    def __init__(self, clock: Clock, latch: Latch | None) -> None:
        super().__init__()
        self.clock, self.latch = clock, latch
        self.ears: list[Inbox] = []

    def subscription(self, topic: str, types: object, handler: Any = None) -> Inbox:
        self.ears.append(Inbox(handler))
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
        for said in self.said.get("stop", Said("stop")).take():
            self.latch.obey(said)
        status = DriveStatus.zero()
        stop = self.latch.stop
        status.state, status.why = ("stopped", "a stop") if stop else self.calm
        status.stop = stop.id if stop else 0
        for inbox in self.ears:
            inbox.waiting.append(status)
            if inbox.handler:
                inbox.handler(SimpleNamespace(message=status, at=self.clock.time))

    def __enter__(self) -> "Robot":
        return self

    def __exit__(self, *exc: object) -> None:
        pass


Type = Callable[..., tuple[int, str, str]]


@pytest.fixture
def latch() -> Latch:
    return Latch()


@pytest.fixture
def typed(clock: Clock, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Type:
    """Type `zteleop stop` beside a robot, or beside none."""
    monkeypatch.setattr(verb, "person", lambda: "ann@desk")

    def type_(latch: Latch | None, *arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(options, "join", lambda name, settings: Robot(clock, latch))
        code = run_verb("stop", "stop a robot", list(arguments))
        return code, *capsys.readouterr()

    return type_


def test_a_stop_is_one_line_that_says_how_to_release_it(latch: Latch, typed: Type) -> None:
    assert typed(latch, "archangel", "--why", "a cat") == (
        0,
        "archangel is stopped (acknowledged within 10 ms); "
        "zteleop stop --release archangel lets it drive again, from neutral\n",
        "",
    )
    assert latch.stop
    assert (latch.stop.by, latch.stop.why) == ("ann@desk", "a cat")


def test_a_release_is_one_line(latch: Latch, typed: Type) -> None:
    typed(latch)
    assert typed(latch, "--release") == (
        0,
        "archangel may drive again, from neutral (acknowledged within 10 ms)\n",
        "",
    )
    assert latch.stop is None


def test_a_release_of_what_is_not_stopped_is_done_already(latch: Latch, typed: Type) -> None:
    assert typed(latch, "--release") == (0, "archangel is not stopped\n", "")


def test_a_stop_that_nobody_acknowledges_is_an_error_that_says_what_to_do(typed: Type) -> None:
    assert typed(None) == (
        1,
        "",
        "zteleop stop: archangel has not acknowledged the stop within 2 s: "
        "cut its power, or run zteleop neutral on it\n",
    )


def test_a_release_of_a_robot_that_is_not_heard_is_an_error(typed: Type) -> None:
    code, out, error = typed(None, "--release")
    assert (code, out) == (1, "")
    assert error == "zteleop stop: archangel is not heard, so nothing is released; is it on?\n"


def test_the_first_word_leaves_before_anything_is_waited_for(clock: Clock) -> None:
    node = Robot(clock, None)
    order: list[str] = []
    node.publisher = lambda topic, types: SimpleNamespace(
        matched=False, publish=lambda said: order.append("said")
    )
    node.subscription = lambda *arguments: order.append("subscribed")
    node.until = lambda look, seconds: order.append("waited")
    with pytest.raises(OSError, match="asking"):
        verb.stop(node)
    assert order == ["said", "subscribed", "waited"]


def test_what_a_stranger_says_cannot_steer_the_terminal(
    latch: Latch, typed: Type, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Robot, "calm", ("fault", "\x1b[2Jevil"))
    typed(latch)
    code, out, _ = typed(latch, "--release")
    assert code == 0
    assert out == "the stop of archangel is over, but it is kept at rest: \\u001b[2Jevil\n"
