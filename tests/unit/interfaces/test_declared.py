import pytest

from zteleop.errors import MessageError
from zteleop.interfaces.declared import declared, message_in, parts
from zteleop.interfaces.msg_text import Constant, Field, Type
from zteleop.interfaces.structs import struct_of
from zteleop.messages import Beat, DriveStatus, Header, Log, Message, Pwm, Time, Twist, TwistStamped, Why


def test_what_ros_has_written_is_what_is_declared() -> None:
    assert declared(TwistStamped).fields == (
        Field(Type("std_msgs/msg/Header"), "header"),
        Field(Type("geometry_msgs/msg/Twist"), "twist"),
    )
    assert Constant(Type("uint8"), "DEBUG", 10) in declared(Log).constants


def test_what_only_we_have_is_declared_in_ros_own_types() -> None:
    named = [(field.type.name, field.name) for field in declared(Beat).fields]
    assert named == [("int64", "epoch"), ("float64", "time"), ("float64", "floor")]
    assert declared(Pwm).ros_type == "zteleop_msgs/msg/Pwm"
    (layers,) = declared(Why).fields
    assert layers.type == Type("zteleop_msgs/msg/Layer", array="unbounded")


def test_a_message_and_all_within_it_each_once() -> None:
    assert list(parts(TwistStamped)) == [
        "geometry_msgs/msg/TwistStamped",
        "std_msgs/msg/Header",
        "builtin_interfaces/msg/Time",
        "geometry_msgs/msg/Twist",
        "geometry_msgs/msg/Vector3",
    ]
    assert parts(TwistStamped)["builtin_interfaces/msg/Time"] is Time
    assert set(parts(Twist).values()) <= set(parts(DriveStatus).values())


def test_the_message_that_a_field_holds() -> None:
    assert message_in(Header, "std_msgs") is Header
    assert message_in(list[Header], "std_msgs") is Header
    assert message_in(int, "std_msgs") is None


class Odd(Message):
    ros_type = "x/msg/Odd"  # type: ignore[misc]

    anything: dict[str, int]


class Perhaps(Message):
    ros_type = "x/msg/Perhaps"  # type: ignore[misc]

    speed: float | None


@pytest.mark.parametrize("kind", [Odd, Perhaps])
def test_what_ros_has_no_word_for_is_refused(kind: type[Message]) -> None:
    with pytest.raises(MessageError, match=r"ROS has no type for the field '(anything|speed)'"):
        declared(kind)


def test_a_type_of_the_library_is_declared_as_its_text_says() -> None:
    marker = declared(struct_of("visualization_msgs/msg/Marker"))
    assert Constant(Type("int32"), "ARROW", 0) in marker.constants
    assert marker.fields[1] == Field(Type("string"), "ns")
