import argparse
from collections.abc import Callable
from contextlib import nullcontext
from typing import Any

import pytest
from unit.cli.test_why import dog

from zteleop.bus.subscription import Received
from zteleop.cli import watchdog
from zteleop.errors import BusError
from zteleop.messages import WatchdogStatus
from zteleop.testing import Clock, FakeNode

Watch = Callable[..., list[str]]


@pytest.fixture
def node(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> FakeNode:
    node = FakeNode(clock=clock)
    monkeypatch.setattr(watchdog._options, "load_anyhow", lambda arguments: None)
    monkeypatch.setattr("zteleop.bus.presence.robots", lambda session: ["archangle"])
    monkeypatch.setattr(watchdog._options, "join", lambda name, settings: nullcontext(node))
    return node


@pytest.fixture
def watch(node: FakeNode, clock: Clock, capsys: Any) -> Watch:
    """Say some statuses, 0.2 s apart, and return the lines that are printed."""

    def watch(*statuses: WatchdogStatus, once: bool = False) -> list[str]:
        def spin() -> None:
            for status in statuses:
                clock.pass_by(0.2)
                received = Received(status, "robot/archangel/watchdog", None, clock.time)
                node.inboxes["watchdog"].handler(received)
                if node.stopped:
                    return

        node.spin = spin
        watchdog.run(argparse.Namespace(once=once))
        return capsys.readouterr().out.splitlines()

    return watch


def test_a_line_tells_the_robot_and_what_its_watchdog_sees(watch: Watch) -> None:
    (line,) = watch(dog())
    assert line.startswith(
        "archangel  watching: the actuator steps, within the last 50 ms; sees pulses of rest"
    )
    assert line.endswith("; 7 commands heard")


def test_a_line_a_second_while_nothing_changes(watch: Watch) -> None:
    assert len(watch(*[dog(commands=n, silence=n / 100) for n in range(16)])) == 4


@pytest.mark.parametrize(
    "news",
    [
        {"moving": True},
        {"allowed": True},
        {"restarts": 1},
        {"state": "resting"},
        {"why": "it ended"},
    ],
)
def test_a_line_at_each_change(watch: Watch, news: dict[str, Any]) -> None:
    assert len(watch(dog(), dog(), dog(**news), dog(**news))) == 2


def test_once_is_one_line(watch: Watch) -> None:
    assert len(watch(dog(), dog(moving=True), once=True)) == 1


def test_what_the_bus_says_cannot_write_on_the_screen(watch: Watch) -> None:
    (line,) = watch(dog(why="\x1b[2J\nit ended", state="resting"))
    assert "\x1b" not in line


def test_a_watchdog_that_is_not_heard_is_an_error_in_words(node: FakeNode, clock: Clock) -> None:
    node.spin = lambda: node.live(3.0)
    here = r"heard here: archangle; did you mean archangle\?"
    words = rf"no watchdog of archangel has been heard for 1.5 s \({here}\); if the robot moves"
    with pytest.raises(BusError, match=words):
        watchdog.run(argparse.Namespace(once=False))


def test_one_that_falls_silent_later_is_an_error_too(node: FakeNode, clock: Clock) -> None:
    def spin() -> None:
        node.live(1.4)
        received = Received(dog(), "robot/archangel/watchdog", None, clock.time)
        node.inboxes["watchdog"].handler(received)
        node.live(1.4)
        with pytest.raises(BusError, match="no watchdog"):
            node.live(1.0)

    node.spin = spin
    watchdog.run(argparse.Namespace(once=False))
