from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.errors import MessageError
from zteleop.interfaces.msg_text import (
    NO_DEFAULT,
    Constant,
    Definition,
    Field,
    Type,
    parse_action,
    parse_message,
    parse_service,
    parse_type,
)

GARDEN = """\ufeff# Not part of it.
uint8 DRY = 0  # nor is this
uint8 WET=0x0f
string NAME="a # b"\t# quoted
string ROS_1=a # b

std_msgs/Header header
\tint32   count   5\r
float32[] depths [0.5, 1]
Plant[<=3] plants  # in rows
string<=10 label 'it''s'[]
"""


def fields(text: str) -> tuple[Field, ...]:
    return parse_message(text, "garden_msgs/msg/Soil").fields


def constants(text: str) -> tuple[Constant, ...]:
    return parse_message(text, "garden_msgs/msg/Soil").constants


def test_a_message_is_its_constants_and_its_fields_in_order() -> None:
    text = GARDEN.rpartition("string<=10")[0]
    assert parse_message(text, "garden_msgs/msg/Soil") == Definition(
        "garden_msgs/msg/Soil",
        fields=(
            Field(Type("std_msgs/msg/Header"), "header"),
            Field(Type("int32"), "count", 5),
            Field(Type("float32", array="unbounded"), "depths", (0.5, 1.0)),
            Field(Type("garden_msgs/msg/Plant", None, "bounded", 3), "plants", NO_DEFAULT),
        ),
        constants=(
            Constant(Type("uint8"), "DRY", 0),
            Constant(Type("uint8"), "WET", 15),
            Constant(Type("string"), "NAME", "a # b"),
            Constant(Type("string"), "ROS_1", "a # b"),
        ),
    )


def test_an_error_says_where_it_is_and_what_was_expected() -> None:
    with pytest.raises(MessageError, match=r"garden_msgs/msg/Soil, line 11: expected a text that ends with"):
        parse_message(GARDEN, "garden_msgs/msg/Soil")


def test_a_message_may_be_empty() -> None:
    assert parse_message("", "std_msgs/msg/Empty") == Definition("std_msgs/msg/Empty", (), ())


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("bool", Type("bool")),
        ("byte", Type("byte")),
        ("wstring<=7", Type("wstring", 7)),
        ("string<=7[<=2]", Type("string", 7, "bounded", 2)),
        ("float64[36]", Type("float64", None, "fixed", 36)),
        ("uint8[]", Type("uint8", None, "unbounded")),
        ("Vector3", Type("geometry_msgs/msg/Vector3")),
        ("std_msgs/Bool", Type("std_msgs/msg/Bool")),
        ("std_msgs/msg/Bool[4]", Type("std_msgs/msg/Bool", None, "fixed", 4)),
        ("std_srvs/srv/SetBool_Request[<=1]", Type("std_srvs/srv/SetBool_Request", None, "bounded", 1)),
        ("Header", Type("std_msgs/msg/Header")),
        ("time", Type("builtin_interfaces/msg/Time")),
        ("duration[]", Type("builtin_interfaces/msg/Duration", None, "unbounded")),
    ],
)
def test_a_type_is_plain_or_a_message_and_one_or_many(text: str, found: Type) -> None:
    assert parse_type(text, "geometry_msgs") == found


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("int32", "expected a type and a name, such as float64 x, found 'int32'"),
        ("int32 5x", "expected a type and a name"),
        ("int32 x-y", "expected a type and a name"),
        ("---", "expected a type and a name"),
        ("int32 # x", "expected a type and a name"),
        ("int32[ x", "expected a type such as int32"),
        ("a/b/c/D x", "expected a type such as int32"),
        ("../msg/D x", "expected a type such as int32"),
        ("pkg/srv/D x", "a field is of a message, package/msg/Name"),
        ("pkg/other/D_Request x", "a field is of a message, package/msg/Name"),
        ("int32<=5 x", "only a string has a bound"),
        ("string<=0 x", "expected a length from 1 to 4294967295, found 'string<=0'"),
        ("int8[0] x", "expected a length from 1"),
        ("int8[<=] x", "expected a length from 1"),
        (f"int8[{2**32}] x", "expected a length from 1"),
        ("int8[99999999999999] x", "expected a length from 1"),
        ("int8 x\nint8 x", "line 2: there are two of the name x"),
        ("int8 x=1\nint8 x", "line 2: there are two of the name x"),
        ("Vector3 x 5", "a message within another has no default"),
        ("Vector3 X=5", "a constant is one number, truth value or text"),
        ("int8[] X=[5]", "a constant is one number, truth value or text"),
    ],
)
def test_what_declares_nothing_is_one_sentence(text: str, why: str) -> None:
    with pytest.raises(MessageError, match=r"garden_msgs/msg/Soil, line \d: ") as error:
        fields(text)
    assert why in str(error.value)


def test_a_line_that_is_too_long_is_told_in_part() -> None:
    with pytest.raises(MessageError) as error:
        fields("x" * 100_000)
    assert len(str(error.value)) < 300


def test_a_service_is_a_request_and_a_response() -> None:
    request, response = parse_service("int8 A=1\nbool data\n--- # then\nbool data", "std_srvs/srv/SetBool")
    assert (request.ros_type, len(request.constants)) == ("std_srvs/srv/SetBool_Request", 1)
    assert response == Definition("std_srvs/srv/SetBool_Response", (Field(Type("bool"), "data"),), ())


def test_its_lines_count_from_the_start_of_the_file() -> None:
    with pytest.raises(MessageError, match="std_srvs/srv/SetBool, line 4: "):
        parse_service("bool data\n---\n\nbool", "std_srvs/srv/SetBool")


def test_an_action_is_a_goal_a_result_and_feedback() -> None:
    parts = parse_action("int32 order\n---\nint32[] sequence\n---\n", "garden_msgs/action/Grow")
    assert [part.ros_type for part in parts] == [
        f"garden_msgs/action/Grow_{end}" for end in ("Goal", "Result", "Feedback")
    ]
    assert [len(part.fields) for part in parts] == [1, 1, 0]


@pytest.mark.parametrize(("text", "count"), [("bool x", 1), ("---\n---\n", 3)])
def test_a_service_of_another_number_of_parts_is_none(text: str, count: int) -> None:
    with pytest.raises(MessageError, match=f"expected 2 parts with a line --- between them, found {count}"):
        parse_service(text, "std_srvs/srv/SetBool")


def test_constants_may_stand_among_fields_and_have_any_name_of_ros_1() -> None:
    assert constants("int8 x\nint8 lower=-1\nbool On = TRUE") == (
        Constant(Type("int8"), "lower", -1),
        Constant(Type("bool"), "On", True),
    )


WORDS = st.sampled_from(
    [*GARDEN.split("\n"), *GARDEN.split(" "), *"=#'\"\\/", "[", "]", "---", "0x", "\x00", "\u2028"]
)
LINES = st.lists(st.lists(WORDS, max_size=6).map(" ".join) | WORDS, max_size=6).map("\n".join)


@pytest.mark.parametrize("parse", [parse_message, parse_service, parse_action])
@given(text=st.text(max_size=80) | LINES)
def test_any_text_is_a_definition_or_a_message_error(parse: Any, text: str) -> None:
    with suppress(MessageError):
        assert parse(text, "garden_msgs/msg/Soil")
