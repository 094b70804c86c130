"""Parameters that pages look at and change: by the nodes' own services, and never in the loop that drives."""

import json
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from zteleop.bridges.web import tuning
from zteleop.bridges.web.slots import Slots
from zteleop.bridges.web.tuning import ASK_EVERY, Tuning
from zteleop.bridges.web.words import Setting
from zteleop.bus.parameters import Bounds, Parameters
from zteleop.errors import BusError
from zteleop.messages import (
    DescribeParametersRequest,
    GetParametersRequest,
    ListParametersRequest,
    SetParametersRequest,
)
from zteleop.testing import Clock, FakeNode


class Actuator(Parameters):
    """A node with parameters, asked without a bus."""

    def __init__(self) -> None:
        super().__init__(lambda line: None)
        self.answers = True
        self.declare("speed", 2.0, "m/s", Bounds(0.0, 3.0), None)
        self.declare("tries", 2, "", Bounds(1, 5), None)
        self.declare("level", "info", "", Bounds(choices=("debug", "info")), None)
        self.declare("on", True, "", Bounds(), None)

    def names(self) -> list[str]:
        if not self.answers:
            raise BusError("nobody answers")
        return self.list(ListParametersRequest([], 0)).result.names

    def asked(self, session: Any, robot: str, node: str) -> Any:
        return SimpleNamespace(
            names=self.names,
            get=lambda names: self.get(GetParametersRequest([*names])).values,
            describe=lambda names: self.describe(DescribeParametersRequest([*names])).descriptors,
            set=lambda given: self.set(SetParametersRequest([*given])).results,
        )


class Room:
    """A page that looks, and the thread that asks, which a test runs by hand."""

    def __init__(self, clock: Clock, actuator: Actuator) -> None:
        self.clock, self.actuator = clock, actuator
        self.looks: list[Callable[[], float]] = []
        self.asks: list[int] = []
        node = FakeNode(clock=clock)
        node.membership.beside = self.looks.append  # type: ignore[attr-defined]
        self.tuning = Tuning(node)
        self.slots = {page: Slots(lambda: None) for page in ("page 1", "page 2")}

    def look(self, page: str = "page 1", looks: bool = True) -> None:
        self.tuning.look(page, self.slots[page], looks)

    def set(self, name: str, value: Any, page: str = "page 1") -> None:
        self.tuning.set(self.slots[page], Setting("actuator", name, value))

    def told(self, page: str = "page 1", seconds: float = 0.0) -> list[dict[str, Any]]:
        self.clock.pass_by(seconds)
        for look in self.looks:
            look()
        return [json.loads(frame) for frame in iter(self.slots[page].take, None)]


@pytest.fixture
def room(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> Room:
    actuator = Actuator()
    monkeypatch.setattr(tuning, "NodeParameters", actuator.asked)
    here = [SimpleNamespace(robot="archangel", node="actuator"), SimpleNamespace(robot="abe", node="arm")]
    room = Room(clock, actuator)
    monkeypatch.setattr(tuning.presence, "with_parameters", lambda session: room.asks.append(1) or here)
    return room


def values(words: list[dict[str, Any]]) -> dict[str, Any]:
    return {one["name"]: one["value"] for word in words for one in word["parameters"]}


def test_whoever_looks_is_told_what_each_is_and_may_be(room: Room) -> None:
    room.look()
    (word,) = room.told()
    found = {one.pop("name"): one for one in word["parameters"]}
    assert {one["node"] for one in found.values()} == {"actuator"}
    kinds = {name: (one["type"], one["value"], one["least"], one["most"]) for name, one in found.items()}
    assert kinds == {
        "speed": ("double", 2.0, 0.0, 3.0),
        "tries": ("integer", 2, 1, 5),
        "level": ("string", "info", None, None),
        "on": ("boolean", True, None, None),
    }
    assert found["level"]["choices"] == ["debug", "info"]
    assert found["speed"]["says"] == "m/s"


def test_nobody_is_asked_while_nobody_looks(room: Room) -> None:
    assert room.looks == []
    room.look()
    room.look(looks=False)
    assert room.told(seconds=60.0) == []
    assert (len(room.looks), room.asks) == (1, [])


@pytest.mark.parametrize(
    ("name", "value", "now"),
    [("speed", 1, 1.0), ("tries", 4, 4), ("level", "debug", "debug"), ("on", False, False)],
)
def test_a_page_changes_one_and_all_who_look_see_it_at_once(
    room: Room, name: str, value: Any, now: Any
) -> None:
    for page in ("page 1", "page 2"):
        room.look(page)
    room.told()
    room.told("page 2")
    room.set(name, value)
    assert values(room.told())[name] == now
    assert values(room.told("page 2"))[name] == now


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("speed", 9.0, "actuator: speed: expected 0 to 3, found 9"),
        ("tries", 1.5, "actuator: tries: "),
        ("speed", "fast", "actuator: speed: could not convert"),
        ("level", True, "actuator: level: "),
    ],
)
def test_what_may_not_be_is_told_to_who_wished_it_and_what_is_stands_again(
    room: Room, name: str, value: Any, words: str
) -> None:
    for page in ("page 1", "page 2"):
        room.look(page)
    before = values(room.told())
    room.told("page 2")
    room.set(name, value)
    note, word = room.told()
    assert note["alarm"]
    assert words in note["says"]
    assert values([word]) == before
    assert not [one for one in room.told("page 2") if one["is"] == "note"]


def test_what_others_change_is_seen_within_seconds_and_what_stays_is_not_said_again(room: Room) -> None:
    room.look()
    room.told()
    assert room.told(seconds=ASK_EVERY) == []
    room.actuator._declared["speed"].value = 0.5
    assert values(room.told(seconds=ASK_EVERY))["speed"] == 0.5


def test_who_comes_later_is_told_what_is_known(room: Room) -> None:
    room.look()
    room.told()
    room.look("page 2")
    assert values(room.told("page 2"))["speed"] == 2.0


def test_a_node_that_does_not_answer_has_none_and_comes_back(room: Room) -> None:
    room.actuator.answers = False
    room.look()
    assert values(room.told()) == {}
    room.actuator.answers = True
    assert values(room.told(seconds=ASK_EVERY))["speed"] == 2.0
