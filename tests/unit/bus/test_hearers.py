from typing import ClassVar

import pytest
from unit.bus.fakes import Session, put

from zteleop.bus import presence
from zteleop.bus.hearers import FIRST_LOOK, LOOK_EVERY, Hearers, told_apart
from zteleop.bus.loop import Loop
from zteleop.bus.names import Name
from zteleop.messages import Bool, Message, String
from zteleop.testing import Clock

CHATTER = Name("abe", "chatter")


class Soil(Message):
    ros_type: ClassVar[str] = "acme_msgs/msg/Soil"

    moisture: float


def key(node: str, ros_type: str) -> str:
    return f"robot/abe/live/sub/{node}/pi-7/{ros_type}/chatter"


class Desk:
    """A publisher's loop, and whoever comes to hear it."""

    def __init__(self, clock: Clock, kind: type[Message]) -> None:
        self.session, self.told, self._clock = Session(), list[str](), clock
        self.loop = Loop(lambda: None)
        Hearers(self.session, CHATTER, [kind], self.told.append).watch(self.loop)  # type: ignore[arg-type]

    def comes(self, *keys: str, is_put: bool = True) -> None:
        self.session.comings.samples.extend(put(b"", key=key, is_put=is_put) for key in keys)

    def waits(self, seconds: float) -> None:
        self._clock.pass_by(seconds)
        self.loop.run_once(self._clock.time)


def test_who_was_here_and_who_comes_later_is_told_of_once(clock: Clock) -> None:
    desk = Desk(clock, String)
    desk.comes(key("ear", "std_msgs.msg.Bool"))
    desk.waits(FIRST_LOOK)
    how = "hears std_msgs/msg/Bool alone, and drops what is said here, std_msgs/msg/String"
    assert desk.told == [f"abe/chatter: ear on pi-7 {how}"]
    desk.comes(key("nose", "std_msgs.msg.Int16"))
    desk.waits(LOOK_EVERY)
    desk.waits(LOOK_EVERY)
    assert [words.split()[1] for words in desk.told] == ["ear", "nose"]
    desk.loop.close()


@pytest.mark.parametrize(
    "token",
    [
        key("ear", "std_msgs.msg.String"),
        key("echo", "any"),
        "robot/abe/live/sub/short",
        "robot/abe/live/sub/ear\x1b/pi-7/std_msgs.msg.Bool/chatter",
    ],
)
def test_of_who_hears_it_nothing_is_told_nor_of_what_is_no_token(clock: Clock, token: str) -> None:
    desk = Desk(clock, String)
    desk.comes(token)
    desk.comes(key("ear", "std_msgs.msg.Bool"), is_put=False)
    desk.waits(FIRST_LOOK)
    desk.loop.close()
    assert desk.told == []


def test_who_hears_what_is_said_and_more_is_told_of_to_nobody(clock: Clock) -> None:
    desk = Desk(clock, String)
    desk.comes(key("ear", "std_msgs.msg.Bool,std_msgs.msg.String"))
    desk.waits(FIRST_LOOK)
    desk.loop.close()
    assert desk.told == []


def test_a_type_of_ones_own_is_another_where_its_fields_are(clock: Clock) -> None:
    own = presence.endpoint_key(CHATTER, "sub", "ear", [Soil])
    assert own.split("/")[6].startswith("acme_msgs.msg.Soil~")
    desk = Desk(clock, Soil)
    desk.comes(own, own.replace("Soil~", "Soil~f"))
    desk.waits(FIRST_LOOK)
    desk.loop.close()
    (words,) = desk.told
    hashed = presence.type_of(Soil)[1]
    assert f"hears f{hashed} alone, and drops what is said here, acme_msgs/msg/Soil {hashed}" in words


def test_two_types_differ_by_what_differs() -> None:
    assert told_apart(("a/msg/A", "1"), ("b/msg/B", "2")) == ("a/msg/A", "b/msg/B")
    assert told_apart(("a/msg/A", "1"), ("a/msg/A", "2")) == ("a/msg/A 1", "2")
    assert told_apart((Bool.ros_type, ""), (Bool.ros_type, "")) == (Bool.ros_type, "another")
