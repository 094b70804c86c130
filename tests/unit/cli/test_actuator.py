import argparse
from collections.abc import Callable
from contextlib import nullcontext
from types import SimpleNamespace
from typing import Any

import pytest
from unit.bus.fakes import Session

from zteleop.bus import presence
from zteleop.bus.node import Node
from zteleop.bus.session import ROBOT_ENDPOINT, BusSettings
from zteleop.cli import actuator, obey
from zteleop.config import Config
from zteleop.control.drive import DriveSettings
from zteleop.control.mixer import Differential
from zteleop.control.servo import Servo
from zteleop.errors import ConfigError, DeviceError

TANK = DriveSettings(mixer=Differential(), servos={"left": Servo(channel=0), "right": Servo(channel=1)})


def tuned(drive: DriveSettings | None = None, **typed: Any) -> DriveSettings:
    arguments = argparse.Namespace(**{"pulse_duty": None, "neutral_offset": 0} | typed)
    return actuator._tuned(Config(drive=drive or DriveSettings()), arguments, 4.0)


def test_nothing_typed_changes_nothing() -> None:
    assert tuned() == DriveSettings()
    assert tuned(TANK) == TANK


def test_the_pulse_duty_typed_is_obeyed() -> None:
    assert tuned(pulse_duty=0.8).limits.pulse_duty == 0.8


def test_an_offset_shifts_the_throttles_neutral_by_ticks() -> None:
    servos = tuned(neutral_offset=-3).servos
    assert servos["throttle"].neutral_us == pytest.approx(1509.6 - 12.0)
    assert servos["steering"] == DriveSettings().servos["steering"]


@pytest.mark.parametrize(
    ("typed", "words"),
    [
        ({"pulse_duty": 0.0}, r"Expected `float` > 0\.0"),
        ({"pulse_duty": 1.1}, r"Expected `float` <= 1\.0"),
        ({"pulse_duty": float("nan")}, "Expected `float` > 0.0"),
        ({"neutral_offset": 200}, "neutral_us must lie between min_us and max_us"),
        ({"neutral_offset": -(10**6)}, "Expected `float` >= 500.0"),
        ({"neutral_offset": 10**400}, "int too large"),
    ],
)
def test_what_cannot_be_obeyed_is_refused(typed: dict[str, Any], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        tuned(**typed)


def test_a_vehicle_without_a_throttle_has_no_neutral_to_shift() -> None:
    with pytest.raises(ConfigError, match="throttle"):
        tuned(TANK, neutral_offset=3)


@pytest.fixture
def join(monkeypatch: pytest.MonkeyPatch) -> Callable[..., Any]:
    """Join a bus on which these watchdogs are, and some more as soon as this one has shown itself."""

    def join(before: list[str], meanwhile: list[str], own: str = "pi-7", speaks: bool = True) -> Any:
        session = Session(f"robot/archangel/live/node/watchdog/{holder}" for holder in before)
        monkeypatch.setattr(presence, "process", lambda: own)
        monkeypatch.setattr(actuator, "open_session", lambda *_, **options: nullcontext(session))

        def node(*arguments: Any, **options: Any) -> Node:
            late = [f"robot/archangel/live/node/watchdog/{holder}" for holder in meanwhile]
            session.alive.keys += late
            node = Node(*arguments, **options)
            node.warnings = []
            monkeypatch.setattr(node.log, "warn", node.warnings.append)
            monkeypatch.setattr(node, "until", lambda look, seconds: speaks)
            return node

        monkeypatch.setattr(actuator, "Node", node)
        return actuator._join("archangel", BusSettings())

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
    bus, childs = actuator._door(BusSettings(), PRIVATE)
    assert bus.listen == [ROBOT_ENDPOINT, "tcp/[::]:0", PRIVATE]
    assert (childs.mode, childs.connect, childs.listen, childs.multicast) == ("client", [PRIVATE], [], False)
    assert bus.largest == childs.largest == actuator.LARGEST


@pytest.mark.parametrize(
    ("typed", "listen"),
    [
        (BusSettings(listen=["tcp/[::]:1"]), ["tcp/[::]:1", PRIVATE]),
        (BusSettings(multicast=False), [PRIVATE]),
        (BusSettings(mode="router", listen=["tcp/[::]:1"]), ["tcp/[::]:1", PRIVATE]),
    ],
)
def test_what_was_typed_of_its_doors_stays(typed: BusSettings, listen: list[str]) -> None:
    assert actuator._door(typed, PRIVATE)[0].listen == listen


def test_a_client_has_no_door_and_its_actuator_is_one_too() -> None:
    client = BusSettings(mode="client", connect=["tcp/hub:7447"])
    assert actuator._door(client, PRIVATE) == (client, client)


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
    switch = actuator._switch(SimpleNamespace(), pin)
    switch(True)
    switch(False)
    assert pin.states == [True, False]


def test_without_a_pin_nothing_is_switched() -> None:
    actuator._switch(SimpleNamespace(), None)(True)


def test_a_pin_that_fails_is_said_and_ends_nothing() -> None:
    errors: list[str] = []
    node = SimpleNamespace(log=SimpleNamespace(error=lambda text, subject: errors.append(text)))
    actuator._switch(node, Pin(fails=True))(False)
    assert errors == ["OE is gone"]


def test_with_a_link_it_is_the_one_that_is_watched(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obey, "run", lambda number: 40 + number)
    assert actuator.run(argparse.Namespace(link=2)) == 42
