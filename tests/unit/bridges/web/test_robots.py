"""All robots on the bus, for pages that look at them."""

import json
from typing import Any

import pytest
from unit.bus.fakes import Session, put, sample

from zteleop.bridges.web.robots import GONE, MOST, SILENT, Fleet
from zteleop.bridges.web.slots import Slots
from zteleop.messages import DriveStatus
from zteleop.testing import Clock, FakeNode

ALL = "robot/*/drive_status"


class Room:
    """A node whose session remembers, and a page that looks."""

    def __init__(self, clock: Clock) -> None:
        self.session, self.node = Session(), FakeNode(clock=clock)
        self.node.membership.session = self.session
        self.fleet, self.slots = Fleet(self.node), Slots(lambda: None)

    def look(self, looks: bool = True) -> None:
        self.fleet.look("page 1", self.slots, looks)

    def say(self, robot: str, state: str = "idle", source: str = "", operator: str = "") -> None:
        status = DriveStatus.zero()
        status.state, status.why = state, f"{robot} is {state}"  # type: ignore[assignment]
        status.source, status.operator = source, operator
        self.session.rings[ALL].samples.append(sample(status, f"robot/{robot}/drive_status"))

    def told(self, seconds: float = 1.0) -> dict[str, Any]:
        self.node.loop.live(seconds)
        frames = [json.loads(frame) for frame in iter(self.slots.take, None)]
        return {one.pop("name"): one for one in frames[-1]["robots"]} if frames else {}


@pytest.fixture
def room(clock: Clock) -> Room:
    return Room(clock)


def test_each_robot_is_told_with_what_it_does_and_who_operates_it(room: Room) -> None:
    room.look()
    room.say("bert")
    room.say("anna", "driving", "keyboard", "18d4")
    assert room.told() == {
        "anna": {"state": "driving", "why": "anna is driving", "operator": "keyboard 18d4"},
        "bert": {"state": "idle", "why": "bert is idle", "operator": ""},
    }
    room.say("anna", "stopped")
    assert room.told()["anna"]["state"] == "stopped"


def test_one_that_is_silent_is_said_to_be_and_later_no_more(room: Room) -> None:
    room.look()
    room.say("anna", "driving", "keyboard", "18d4")
    room.told()
    silent = {"state": "silent", "why": "it has said nothing for 3 s", "operator": ""}
    assert room.told(SILENT)["anna"] == silent
    assert room.told(GONE) == {}


def test_another_version_and_what_is_no_robot_harm_nothing(room: Room) -> None:
    room.look()
    samples = room.session.rings[ALL].samples
    samples.append(put(b"{}", "application/json;zteleop_msgs/msg/DriveStatus", "robot/old/drive_status"))
    samples.append(put(b"{}", key="robot/No Robot/drive_status"))
    samples.append(put(b"", key="robot/gone/drive_status", is_put=False))
    found = room.told()
    assert [*found] == ["old"]
    assert found["old"]["state"] == "unknown"


def test_of_too_many_the_first_are_told(room: Room) -> None:
    room.look()
    for number in range(MOST + 5):
        room.say(f"r{number}")
    room.say("r0", "stopped")
    found = room.told()
    assert len(found) == MOST
    assert found["r0"]["state"] == "stopped"


def test_they_are_heard_for_as_long_as_somebody_looks(room: Room) -> None:
    assert room.told() == {}
    assert ALL not in room.session.rings
    room.look()
    room.say("anna")
    assert room.told()
    room.look(looks=False)
    assert not room.session.rings[ALL].declared
    assert room.told() == {}
    room.look()
    assert room.told() == {}, "what was known before may not be so any more"
