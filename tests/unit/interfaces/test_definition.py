from typing import Annotated, Any, ClassVar, Literal

import pytest
from msgspec import Meta

from zteleop.interfaces.definition import Field, definition, field_of
from zteleop.interfaces.foreign import struct_of
from zteleop.interfaces.schema import schema
from zteleop.messages import Message, ParameterValue, Twist, TwistStamped, Vector3
from zteleop.messages.std import Int8, Int64, UInt8, UInt32, UInt64


class Soil(Message):
    """How wet a pot is.

    Once an hour.
    """

    ros_type: ClassVar[str] = "garden_msgs/msg/Soil"

    DRY: ClassVar[int] = 0
    FROZEN: ClassVar[int] = -1

    wetness: Annotated[float, Meta(ge=0, le=1)]
    """1 is a pond."""
    place: Vector3


SOIL = """# How wet a pot is.
#
# Once an hour.
uint8 DRY=0
int32 FROZEN=-1
float64 wetness  # 0 to 1; 1 is a pond.
geometry_msgs/Vector3 place
\tfloat64 x
\tfloat64 y
\tfloat64 z"""


@pytest.mark.parametrize(
    ("annotation", "field"),
    [
        (bool, Field("bool")),
        (float, Field("float64")),
        (int, Field("int64")),
        (str, Field("string")),
        (bytes, Field("uint8[]")),
        (dict, Field("object")),
        (Any, Field("any")),
        (Int8, Field("int8")),
        (UInt8, Field("uint8")),
        (UInt32, Field("uint32")),
        (Int64, Field("int64")),
        (UInt64, Field("uint64")),
        (list[Int8], Field("int8[]")),
        (Annotated[list[float], Meta(min_length=36, max_length=36)], Field("float64[36]")),
        (Annotated[list[str], Meta(max_length=3)], Field("string[<=3]")),
        (Annotated[list[str], Meta(min_length=3)], Field("string[]")),
        (Annotated[str, Meta(max_length=9)], Field("string<=9")),
        (Annotated[int, Meta(ge=0, le=100)], Field("int64", "0 to 100")),
        (Annotated[int, Meta(ge=0, lt=2**53)], Field("int64", f"0 to {2**53 - 1}")),
        (Annotated[float, Meta(gt=0)], Field("float64", "more than 0")),
        (Annotated[float, Meta(ge=0, lt=1)], Field("float64", "at least 0, less than 1")),
        (Literal["clay", "sand"], Field("string", "clay or sand")),
        (Literal[1, 2], Field("int64", "1 or 2")),
        (float | None, Field("float64", "or null")),
        (Vector3, Field("Vector3", message=Vector3)),
        (list[TwistStamped], Field("TwistStamped[]", message=TwistStamped)),
        (ParameterValue, Field("rcl_interfaces/ParameterValue", message=ParameterValue)),
    ],
)
def test_a_field_is_what_ros_calls_it(annotation: Any, field: Field) -> None:
    assert field_of(annotation, "geometry_msgs") == field


def test_what_is_within_is_indented_below_its_field() -> None:
    vector = "Vector3 {}\n\tfloat64 x\n\tfloat64 y\n\tfloat64 z"
    assert definition(Twist, "none") == f"{vector.format('linear')}\n{vector.format('angular')}"


def test_a_message_tells_its_comments_constants_and_bounds() -> None:
    assert definition(Soil) == SOIL


def test_comments_of_what_is_within_are_left_out_unless_wanted() -> None:
    comment = "\t\t# Seconds and nanoseconds since 1970.\n"
    assert comment not in definition(TwistStamped)
    assert comment in definition(TwistStamped, "all")
    assert "#" not in definition(Soil, "none").replace("  # 0 to 1", "")


def test_a_type_from_the_bus_looks_the_same_but_for_what_its_schema_does_not_tell() -> None:
    told = definition(struct_of(schema(Soil, Soil.ros_type)))
    assert told == SOIL.replace("uint8 DRY=0\nint32 FROZEN=-1\n", "").replace("; 1 is a pond.", "")
