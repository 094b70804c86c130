from collections.abc import Callable
from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any

import pytest
from unit.bus.fakes import Session

from zteleop.bus import presence
from zteleop.bus.node import Node
from zteleop.bus.settings import ROBOT_ENDPOINT, BusSettings
from zteleop.errors import DeviceError
from zteleop.processes import watchdog


@pytest.fixture
def join(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Any]:
    """Join a bus on which these watchdogs are, and some more as soon as this one has shown itself."""

    def join(before: list[str], meanwhile: list[str], own: str = "pi-7", speaks: bool = True) -> Any:
        session = Session(f"robot/archangel/live/node/watchdog/{holder}" for holder in before)
        monkeypatch.setattr(presence, "process", lambda: own)
        monkeypatch.setattr(watchdog, "open_session", lambda *_, **options: nullcontext(session))

        def node(*arguments: Any, **options: Any) -> Node:
            late = [f"robot/archangel/live/node/watchdog/{holder}" for holder in meanwhile]
            session.alive += late
            node = Node(*arguments, **options)
            node.warnings = []
            monkeypatch.setattr(node.log, "warn", node.warnings.append)
            monkeypatch.setattr(node, "until", lambda look, seconds: speaks)
            return node

        monkeypatch.setattr(watchdog, "Node", node)
        return watchdog._join("archangel", BusSettings())

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


PRIVATE = "unixsock-stream//tmp/x/bus"


def test_the_actuator_joins_by_the_watchdogs_door_alone() -> None:
    bus, childs = watchdog._door(BusSettings(), PRIVATE)
    assert bus.listen == [ROBOT_ENDPOINT, "tcp/[::]:0", PRIVATE]
    assert (childs.mode, childs.connect, childs.listen, childs.multicast) == ("client", [PRIVATE], [], False)
    assert bus.largest == childs.largest == watchdog.LARGEST


@pytest.mark.parametrize(
    ("typed", "listen"),
    [
        (BusSettings(listen=["tcp/[::]:1"]), ["tcp/[::]:1", PRIVATE]),
        (BusSettings(multicast=False), [PRIVATE]),
        (BusSettings(mode="router", listen=["tcp/[::]:1"]), ["tcp/[::]:1", PRIVATE]),
    ],
)
def test_what_was_typed_of_its_doors_stays(typed: BusSettings, listen: list[str]) -> None:
    assert watchdog._door(typed, PRIVATE)[0].listen == listen


def test_a_client_has_no_door_and_its_actuator_is_one_too() -> None:
    client = BusSettings(mode="client", connect=["tcp/hub:7447"])
    assert watchdog._door(client, PRIVATE) == (client, client)


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
