"""Who speaks of what, and how often: heard for as long as a page looks, and no longer."""

import json
from typing import Any

import pytest
from unit.bus.fakes import Ring, Session, put

from zteleop.bridges.web.company import COUNT_EVERY, DEPTH, SECONDS, Company
from zteleop.bridges.web.slots import Slots
from zteleop.testing import Clock, FakeNode

ODOM = "nav_msgs.msg.Odometry"
ALL = "robot/archangel/**"


class Room:
    """A node whose session remembers, and pages that look."""

    def __init__(self, clock: Clock) -> None:
        self.session, self.node = Session(), FakeNode(clock=clock)
        self.node.membership.session = self.session
        self.company = Company(self.node)
        self.slots = {page: Slots(lambda: None) for page in ("page 1", "page 2")}

    def look(self, page: str = "page 1", looks: bool = True) -> None:
        self.company.look(page, self.slots[page], looks)

    def come(self, kind: str, node: str, topic: str, ros_type: str = ODOM, process: str = "pi-1") -> None:
        key = f"robot/archangel/live/{kind}/{node}/{process}/{ros_type}/{topic}"
        self.session.comings.samples.append(put(b"", "", key))

    def say(self, topic: str, times: int) -> None:
        said = [put(b"1", key=f"robot/archangel/{topic}") for _ in range(times)]
        self.session.rings[ALL].samples.extend(said)

    def told(self, page: str = "page 1", seconds: float = 1.05) -> list[dict[str, Any]]:
        self.node.loop.live(seconds)
        frames = [json.loads(frame) for frame in iter(self.slots[page].take, None)]
        return frames[-1]["topics"] if frames else []

    @property
    def ring(self) -> Ring | None:
        return self.session.rings.get(ALL)


@pytest.fixture
def room(clock: Clock) -> Room:
    return Room(clock)


def test_each_topic_is_told_with_who_says_it_who_hears_it_and_how_often(room: Room) -> None:
    room.look()
    room.come("pub", "actuator", "odom")
    for process in ("pi-1", "pi-2"):
        room.come("sub", "keyboard", "odom", process=process)
    for ros_type in (ODOM, "any"):  # of one process, by two names
        room.come("sub", "sim", "odom", ros_type)
    room.say("odom", 20)
    (odom,) = room.told()
    assert odom.pop("hz") == pytest.approx(20, rel=0.1)
    assert odom == {
        "name": "odom",
        "types": ["any", "nav_msgs/msg/Odometry"],
        "said_by": ["actuator"],
        "heard_by": ["keyboard", "keyboard", "sim"],
    }


def test_sources_of_commands_are_one_topic(room: Room) -> None:
    room.look()
    room.come("pub", "keyboard", "cmd_vel/keyboard", "geometry_msgs.msg.Twist")
    room.come("pub", "web", "cmd_vel/web", "geometry_msgs.msg.Twist")
    room.say("cmd_vel/web", 5)
    room.say("cmd_vel/keyboard", 5)
    (command,) = room.told()
    assert (command["name"], command["said_by"]) == ("cmd_vel", ["keyboard", "web"])
    assert command["hz"] == pytest.approx(10, rel=0.1)


def test_a_rate_is_taken_over_some_seconds(room: Room) -> None:
    room.look()
    room.told(seconds=0.05)
    for _ in range(SECONDS):
        room.say("odom", 1)
        assert room.told(seconds=1.0)[0]["hz"] == pytest.approx(1, rel=0.1)
    assert room.told(seconds=1.0)[0]["hz"] == pytest.approx(0.8, rel=0.1)
    assert room.told(seconds=SECONDS) == []  # nobody declares it either


def test_who_hears_all_is_nobody_to_whom_a_topic_is_said(room: Room) -> None:
    room.look()
    room.come("pub", "actuator", "odom")
    room.come("sub", "blackbox", "++", "any")
    room.come("srv", "actuator", "actuator/get_parameters", "rcl_interfaces.srv.GetParameters")
    assert [(one["name"], one["heard_by"]) for one in room.told()] == [("odom", [])]


def test_the_bus_is_heard_for_as_long_as_somebody_looks(room: Room) -> None:
    assert room.ring is None
    for page in ("page 1", "page 2"):
        room.look(page)
    room.look("page 1", looks=False)
    assert room.ring
    assert room.ring.declared
    room.company.forget("page 2")
    room.company.forget("page 2")
    assert not room.ring.declared
    room.say("odom", 20)
    assert room.told() == []
    room.look()
    assert room.ring.declared


def test_whoever_looks_no_longer_is_told_nothing(room: Room) -> None:
    room.look("page 1")
    room.look("page 2")
    room.come("pub", "actuator", "odom")
    room.look("page 1", looks=False)
    assert room.told("page 1") == []
    assert room.told("page 2")


def test_what_is_taken_back_is_nothing_that_was_said(room: Room) -> None:
    room.look()
    room.session.rings[ALL].samples.append(put(b"", key="robot/archangel/odom", is_put=False))
    assert room.told() == []


def test_what_was_said_before_a_page_looked_again_does_not_count(room: Room) -> None:
    room.look()
    room.say("odom", 20)
    assert room.told()
    room.look(looks=False)
    room.look()
    assert room.told() == []


def test_a_flood_holds_up_the_loop_that_drives_for_no_longer_than_a_ring_is_deep(room: Room) -> None:
    room.look()
    ring = room.ring
    assert ring
    flood = put(b"1", key="robot/archangel/odom")
    taken: list[int] = []

    def pour() -> Any:
        taken.append(1)
        return flood

    ring.try_recv = pour  # type: ignore[method-assign]
    room.node.loop.run(COUNT_EVERY)
    assert len(taken) == DEPTH
