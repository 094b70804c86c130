from collections.abc import Callable
from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any

import msgspec
import pytest
from unit.bus.fakes import Session

from zteleop.bus import presence
from zteleop.bus.node import Node
from zteleop.bus.settings import ROBOT_ENDPOINT, BusSettings
from zteleop.errors import DeviceError
from zteleop.processes import watchdog
from zteleop.processes.door import Orders


@pytest.fixture
def join(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Any]:
    """Join a bus on which these watchdogs are, and some more as soon as this one has shown itself."""

    def join(before: list[str], meanwhile: list[str], own: str = "pi-7", speaks: bool = True) -> Any:
        session = Session(f"robot/archangel/live/node/watchdog/{holder}" for holder in before)
        monkeypatch.setattr(presence, "process", lambda: own)

        def node(*arguments: Any, **options: Any) -> Node:
            late = [f"robot/archangel/live/node/watchdog/{holder}" for holder in meanwhile]
            session.alive += late
            node = Node(*arguments, **options)
            node.warnings = []
            monkeypatch.setattr(node.log, "warn", node.warnings.append)
            monkeypatch.setattr(node.membership, "until", lambda look, seconds: speaks)
            return node

        monkeypatch.setattr(watchdog, "Node", node)
        return watchdog._join("archangel", session)

    return join


def test_the_only_watchdog_of_a_robot_joins(join: Callable[..., Any]) -> None:
    with join([], []) as node:
        assert (node.name, node.robot) == ("watchdog", "archangel")


@pytest.mark.parametrize("holder", ["pi-6", "pi-8"])
def test_a_second_actuator_is_told_who_has_the_robot(join: Callable[..., Any], holder: str) -> None:
    words = f"robot archangel has an actuator already: {holder}; stop it, or say --robot"
    with pytest.raises(DeviceError, match=f"^{words}$"):
        join([holder], []).__enter__()


@pytest.mark.parametrize(("other", "goes_on"), [("pi-6", False), ("pi-8", True)])
def test_of_two_that_start_at_once_one_goes_on(join: Callable[..., Any], other: str, goes_on: bool) -> None:
    with nullcontext() if goes_on else pytest.raises(DeviceError, match=other), join([], [other]) as node:
        assert node.robot == "archangel"


@pytest.mark.parametrize(("before", "meanwhile"), [(["pi-9"], []), ([], ["pi-6"])])
def test_who_holds_the_place_and_says_nothing_is_passed_over(
    join: Callable[..., Any], before: list[str], meanwhile: list[str]
) -> None:
    (holder,) = before + meanwhile
    with join(before, meanwhile, speaks=False) as node:
        assert node.warnings == [
            f"{holder} holds the place of this robot's watchdog and says nothing; it is passed over"
        ]


def test_the_door_is_where_strangers_look_and_takes_no_huge_messages() -> None:
    bus = watchdog._reachable(BusSettings())
    assert bus.listen == [ROBOT_ENDPOINT, "tcp/[::]:0"]
    assert bus.largest == watchdog.LARGEST


@pytest.mark.parametrize(
    "typed",
    [
        BusSettings(listen=["tcp/[::]:1"]),
        BusSettings(multicast=False),
        BusSettings(mode="router", listen=["tcp/[::]:1"]),
    ],
)
def test_where_it_listens_is_as_typed(typed: BusSettings) -> None:
    assert watchdog._reachable(typed).listen == typed.listen


def test_the_door_of_a_client_joins_its_router() -> None:
    client = BusSettings(mode="client", connect=["tcp/hub:7447"])
    assert watchdog._reachable(client) == client


class Opening:
    """A door that opens, or refuses, after some looks."""

    def __init__(self, looks: int, refused: int = 0) -> None:
        self.is_open, self.refused, self.started = False, 0, False
        self._looks, self._refusal = looks, refused

    def start(self, now: float) -> None:
        self.started = True

    def tend(self, now: float) -> None:
        assert self.started
        self._looks -= 1
        if not self._looks:
            self.refused, self.is_open = self._refusal, not self._refusal


@pytest.mark.parametrize("refused", [0, 2])
def test_a_robot_begins_when_its_door_is_open_and_ends_as_the_door_that_refused(
    monkeypatch: pytest.MonkeyPatch, refused: int
) -> None:
    monkeypatch.setattr(watchdog.time, "sleep", lambda seconds: None)
    assert watchdog._open(Opening(3, refused)) == refused


def test_only_the_first_door_waits_until_all_are_found() -> None:
    told = [
        msgspec.json.decode(watchdog._orders(BusSettings(), first), type=Orders) for first in (True, False)
    ]
    assert [orders.settle for orders in told] == [True, False]
    assert told[0].bus == BusSettings()


class Pin:
    def __init__(self, fails: bool = False) -> None:
        self.fails, self.states = fails, []

    def enable(self) -> None:
        self._set(True)

    def disable(self) -> None:
        self._set(False)

    def _set(self, on: bool) -> None:
        if self.fails:
            raise DeviceError("OE is gone")
        self.states.append(on)


def test_a_pin_lets_pulses_through_and_cuts_them() -> None:
    pin = Pin()
    switch = watchdog._switch(SimpleNamespace(), pin)
    switch(True)
    switch(False)
    assert pin.states == [True, False]


def test_without_a_pin_nothing_is_switched() -> None:
    watchdog._switch(SimpleNamespace(), None)(True)


def test_a_pin_that_fails_is_said_and_ends_nothing() -> None:
    errors: list[str] = []
    node = SimpleNamespace(log=SimpleNamespace(error=lambda text, subject: errors.append(text)))
    watchdog._switch(node, Pin(fails=True))(False)
    assert errors == ["OE is gone"]
