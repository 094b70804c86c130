"""An operator whose device is a page: the same rules as for every other."""

import json
from collections.abc import Callable
from itertools import count
from typing import Any

import pytest
from unit.bus.fakes import Ring, put

from zteleop.bridges.web.cockpit import Cockpit
from zteleop.bridges.web.slots import Slots
from zteleop.bridges.web.words import Held, Look, Watch, Wish
from zteleop.messages import Beat, Vehicle
from zteleop.testing import Clock, FakeNode

BEAT = Beat(5, 900.0, 1.0)


class Server:
    """Pages that are open, what each was told last, and the robot's ears."""

    def __init__(self, node: FakeNode, clock: Clock, car: Vehicle) -> None:
        self.node, self.clock, self.seq = node, clock, count(1)
        self.asked: list[str] = []
        self.besides: list[Callable[[], float]] = []
        node.membership.session.overhear = self.subscribe
        node.membership.session.deliver = self.deliver
        node.membership.session.watch_tokens = lambda selector, depth, history: Ring()
        node.membership.session.tokens = lambda selector: self.asked.append(selector) or set()
        node.membership.beside = self.besides.append
        self.heard: dict[str, Any] = {}
        node.hear_beat(vehicle=car)
        self.cockpit = Cockpit(node, car, "1.0")
        self.slots: dict[str, Slots] = {}

    def subscribe(self, key: str, depth: int) -> Any:
        ring = Ring()
        ring.key, ring.undeclare = key, lambda: self.heard.pop(key)  # type: ignore[attr-defined, method-assign]
        self.heard[key] = print
        return ring

    def deliver(self, inbox: Any, handler: Any, loop: Any) -> Any:
        self.heard[inbox.ring.key] = lambda sample: handler(inbox.read(sample))
        return type("Delivery", (), {"close": lambda delivery: None})()

    def open(self, page: str) -> list[dict[str, Any]]:
        self.slots[page] = Slots(lambda: None)
        self.cockpit.join(page, self.slots[page])
        return self.told(page)

    def told(self, page: str) -> list[dict[str, Any]]:
        return [json.loads(frame) for frame in iter(self.slots[page].take, None)]

    def hold(self, page: str, drive: float | None, seconds: float = 0.1) -> None:
        for _ in range(round(seconds / 0.02)):
            self.clock.pass_by(0.02)
            self.node.hear_beat()
            held = Held(next(self.seq), drive or 0.0, 0.0, drive is not None, BEAT.epoch, BEAT.time)
            self.cockpit.hear(page, held)

    @property
    def speeds(self) -> list[float]:
        """What the robot was told since this was asked for last."""
        return [said.twist.linear.x for said in self.node.said["cmd_vel"].take()]


@pytest.fixture
def server(clock: Clock, car: Vehicle) -> Server:
    return Server(FakeNode("web", clock=clock), clock, car)


def words(told: list[dict[str, Any]], kind: str) -> dict[str, Any]:
    return next(word for word in told if word["is"] == kind)


def test_a_page_is_told_which_robot_this_is_and_who_else_is_here(server: Server) -> None:
    told = server.open("page 1")
    assert words(told, "hello") == {"is": "hello", "robot": "archangel", "version": "1.0", "you": "page 1"}
    assert words(told, "wheel") == {"is": "wheel", "holder": "", "pages": ["page 1"]}
    server.open("page 2")
    assert words(server.told("page 1"), "wheel")["pages"] == ["page 1", "page 2"]


def test_a_page_drives_by_what_it_holds_in_shares_of_what_the_robot_can(server: Server, car: Vehicle) -> None:
    server.open("page 1")
    server.hold("page 1", 0.5)
    assert server.speeds[-1] == pytest.approx(0.5 * car.max_speed)
    assert words(server.told("page 1"), "wheel")["holder"] == "page 1"
    server.hold("page 1", None)
    assert server.speeds[-1] == 0.0


@pytest.fixture
def driven(server: Server) -> Server:
    """The first of two pages drives."""
    for page in ("page 1", "page 2"):
        server.open(page)
    for drive in (None, 0.1, None, 0.5):
        server.hold("page 1", drive)
    assert server.speeds[-1] > 0
    return server


def test_a_second_page_only_watches_until_the_first_hands_over(driven: Server) -> None:
    driven.hold("page 2", -1.0)
    assert all(speed >= 0 for speed in driven.speeds)
    driven.told("page 2")
    driven.hold("page 1", 0.5)
    driven.cockpit.hear("page 2", Wish("take"))
    assert words(driven.told("page 2"), "note")["says"] == "page 1 drives: it must let go, or hand over"
    driven.cockpit.hear("page 1", Wish("hand over"))
    assert driven.speeds[-1] == 0.0
    driven.cockpit.hear("page 2", Wish("take"))
    assert words(driven.told("page 1"), "wheel")["holder"] == "page 2"


def test_a_page_that_is_closed_drives_no_more(driven: Server) -> None:
    driven.cockpit.leave("page 1")
    assert driven.speeds[-1] == 0.0
    assert words(driven.told("page 2"), "wheel") == {"is": "wheel", "holder": "", "pages": ["page 2"]}
    driven.hold("page 1", 0.5)
    assert not any(driven.speeds), "whatever comes from it now"


def test_a_page_that_only_watches_may_stop(driven: Server) -> None:
    driven.cockpit.hear("page 2", Wish("stop"))
    assert driven.speeds[-1] == 0.0
    (stop,) = driven.node.said["stop"].take()
    assert stop.engaged
    driven.hold("page 1", 0.5)
    assert not any(driven.speeds), "it must let go first"


def test_no_release_takes_a_stop_back_that_nobody_has_heard_yet(driven: Server) -> None:
    wheel = driven.cockpit._wheel
    obey, driven.cockpit._teleop.obey = driven.cockpit._teleop.obey, lambda: None
    for of in ("stop", "release"):
        driven.cockpit.hear("page 2", Wish(of))
    assert wheel.wish is not None
    assert wheel.wish.value == "stop"
    driven.cockpit._teleop.obey = obey


def test_a_page_hears_what_it_watches_as_it_was_said_and_nothing_else(driven: Server) -> None:
    driven.cockpit.hear("page 2", Watch(["odom", "a b"]))
    assert words(driven.told("page 2"), "note")["alarm"]
    key = "robot/archangel/odom"
    driven.heard[key](put(b'{"x": 1.50}', "application/json;a/b", key))
    assert [one for one in driven.told("page 1") if one["is"] == "heard"] == []
    (heard,) = [one for one in driven.told("page 2") if one["is"] == "heard"]
    assert heard == {"is": "heard", "topic": "odom", "type": "a/b", "message": {"x": 1.5}}
    driven.cockpit.hear("page 2", Watch([]))
    assert driven.heard == {}


@pytest.mark.parametrize("leaves", [True, False])
def test_the_bus_is_heard_and_nodes_are_asked_for_a_page_that_shows_it(server: Server, leaves: bool) -> None:
    for page in ("page 1", "page 2"):
        server.open(page)
    server.cockpit.hear("page 1", Look(graph=True, parameters=True, robots=True))
    server.node.loop.live(1.1)
    (beside,) = server.besides
    beside()
    assert {"graph", "parameters", "robots"} <= {word["is"] for word in server.told("page 1")}
    assert not {"graph", "parameters", "robots"} & {word["is"] for word in server.told("page 2")}
    if leaves:
        server.cockpit.leave("page 1")
    else:
        server.cockpit.hear("page 1", Look(graph=False, parameters=False, robots=False))
    assert server.heard == {}
    server.asked.clear()
    server.clock.pass_by(60.0)
    beside()
    assert server.asked == []
