"""What a simulation says of whoever moves it."""

import msgspec
import pytest

from zteleop.cli import sim
from zteleop.cli.sim import LOST_AFTER, TELL_AFTER, Attendant, difference
from zteleop.control.limiter import Limits
from zteleop.control.report import to_vehicle
from zteleop.control.settings import DriveSettings
from zteleop.control.vehicles import made_into
from zteleop.messages import Beat, Vehicle
from zteleop.testing import Clock, FakeNode


@pytest.fixture
def node(clock: Clock, monkeypatch: pytest.MonkeyPatch) -> FakeNode:
    monkeypatch.setattr(sim.presence, "here", lambda session, robot: "no actuator is heard here")
    return FakeNode(clock=clock)


def made(kind: str) -> Vehicle:
    return to_vehicle(made_into(DriveSettings(), kind), 1.0)


def beat(node: FakeNode, clock: Clock) -> None:
    node.membership.robot.beat, node.membership.robot.at = Beat(1, clock.time, 0.0), clock.time


def test_its_actuator_is_missed_once_and_told_when_it_comes_goes_and_comes_back(
    node: FakeNode, clock: Clock
) -> None:
    attendant = Attendant(node, "car", made("car"))  # type: ignore[arg-type]
    attendant.look()
    assert node.warnings == []
    clock.pass_by(TELL_AFTER)
    attendant.look()
    attendant.look()
    (words,) = node.warnings
    assert words.startswith("waits for pulses: no actuator of archangel is heard (no actuator is heard here)")
    assert words.endswith("start zteleop actuator --robot archangel")
    beat(node, clock)
    attendant.look()
    attendant.look()
    assert node.infos == ["the actuator of archangel is heard, and moves it"]
    clock.pass_by(LOST_AFTER)
    attendant.look()
    attendant.look()
    assert node.warnings[1:] == ["the actuator of archangel is not heard any more; its chip stays as it is"]
    beat(node, clock)
    attendant.look()
    assert len(node.infos) == 2


def test_an_actuator_that_is_there_at_once_is_not_missed(node: FakeNode, clock: Clock) -> None:
    beat(node, clock)
    attendant = Attendant(node, "car", made("car"))  # type: ignore[arg-type]
    attendant.look()
    assert (node.warnings, len(node.infos)) == ([], 1)


@pytest.mark.parametrize(
    ("kind", "words"),
    [
        ("tank", "that one steers, and this one turns by its wheels"),
        ("create3", "that one steers, and this one turns by its wheels"),
    ],
)
def test_another_vehicle_than_is_driven_is_told_once_and_anew_when_its_actuator_comes_back(
    node: FakeNode, clock: Clock, kind: str, words: str
) -> None:
    attendant = Attendant(node, kind, made(kind))  # type: ignore[arg-type]
    node.membership.robot.vehicle = made("car")
    for _ in range(2):
        beat(node, clock)
        attendant.look()
        attendant.look()
        assert node.warnings[-1].endswith(f"its pulses mean something else: {words}")
        clock.pass_by(LOST_AFTER)
        attendant.look()
    assert len([told for told in node.warnings if "drives another vehicle than this" in told]) == 2


def test_two_vehicles_differ_by_what_full_pulses_do() -> None:
    assert difference(made("tank"), made("create3")) == (
        "at most 1 m/s and 10 rad/s there, 0.306 m/s and 1.9 rad/s here"
    )
    assert not difference(made("create3"), made("create3"))


def test_a_vehicle_that_is_slowed_down_by_its_limits_is_the_same() -> None:
    slow = msgspec.structs.replace(DriveSettings(), limits=Limits(speed=0.2, turn=0.5))
    assert not difference(to_vehicle(slow, 1.0), made("car"))
