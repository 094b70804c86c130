from time import thread_time

import pytest
from hypothesis import given
from hypothesis import strategies as st
from unit.interfaces.cdr.values import halves, kinds

from zteleop.errors import MessageError
from zteleop.interfaces import ros2msg
from zteleop.interfaces.declared import declared, parts
from zteleop.interfaces.ros2msg import struct_of, text
from zteleop.messages import MESSAGES, String, Time, TwistStamped
from zteleop.messages.message import field_types

BETWEEN = "=" * 80
READABLE = [kind for kind in [*kinds(), *halves()] if kind.ros_type != "example_interfaces/msg/WString"]


def test_a_schema_is_the_texts_of_a_type_and_of_all_within_it() -> None:
    lines = text(TwistStamped).splitlines()
    assert lines[:6] == [
        "std_msgs/Header header",
        "geometry_msgs/Twist twist",
        BETWEEN,
        "MSG: std_msgs/Header",
        "builtin_interfaces/Time stamp",
        "string frame_id",
    ]
    assert lines[-4:] == ["MSG: geometry_msgs/Vector3", "float64 x", "float64 y", "float64 z"]


def test_every_type_comes_back_as_it_is() -> None:
    for kind in READABLE:
        found = struct_of(kind.ros_type, text(kind))
        assert found is kind or kind.ros_type not in MESSAGES
        ours = [(field.type, field.name) for field in declared(kind).fields]
        assert [(field.type, field.name) for field in declared(found).fields] == ours, kind.ros_type
        assert found.__struct_fields__ == kind.__struct_fields__
        assert list(parts(found)) == list(parts(kind)), kind.ros_type


def schema(first: str, **others: str) -> str:
    return "\n".join([first, *(f"{BETWEEN}\nMSG: x/{name}\n{lines}" for name, lines in others.items())])


def test_a_type_that_is_not_ours_is_made() -> None:
    found = struct_of("x/msg/Top", schema("Part[2] parts\nint8 K=3\nstring<=4 name", Part="uint8 x # of it"))
    assert found.__struct_fields__ == ("parts", "name")
    assert found.K == 3  # type: ignore[attr-defined]
    assert found.zero() == found(parts=[found.zero().parts[0]] * 2, name="")  # type: ignore[attr-defined, call-arg]


def test_what_everybody_knows_may_be_left_out() -> None:
    found = struct_of("x/msg/Top", "sensor_msgs/Joy joy\ngeometry_msgs/Twist twist\n")
    assert field_types(found)["twist"] is MESSAGES["geometry_msgs/msg/Twist"]
    assert field_types(found)["joy"].__struct_fields__ == ("header", "axes", "buttons")
    assert field_types(field_types(found)["joy"])["header"] is MESSAGES["std_msgs/msg/Header"]


def test_a_type_of_our_name_with_other_fields_is_not_ours() -> None:
    assert struct_of("std_msgs/msg/String", "string data") is String
    found = struct_of("std_msgs/msg/String", "string text")
    assert found is not String
    assert field_types(found) == {"text": str}
    whole = struct_of("x/msg/Top", "std_msgs/String a\n" + BETWEEN + "\nMSG: std_msgs/String\nstring text\n")
    assert field_types(whole)["a"].__struct_fields__ == ("text",)


def test_a_type_of_ours_that_holds_one_with_other_fields_is_not_ours() -> None:
    text_ = text(TwistStamped).replace("string frame_id", "string frame")
    found = struct_of("geometry_msgs/msg/TwistStamped", text_)
    assert found is not TwistStamped
    assert field_types(found)["header"].__struct_fields__ == ("stamp", "frame")


@pytest.mark.parametrize(
    "written",
    [
        "builtin_interfaces/Time stamp\n",
        "builtin_interfaces/Time stamp\r\n"
        + BETWEEN
        + "\r\nMSG: builtin_interfaces/Time\r\nint32 sec\r\nuint32 nanosec\r\n",
        "builtin_interfaces/Time stamp\n"
        + BETWEEN
        + "\nMSG: builtin_interfaces/msg/Time\nint32 sec\nuint32 nanosec\n",
        "time stamp\n",
        "# a comment\n\n  builtin_interfaces/msg/Time   stamp  # when\n",
    ],
)
def test_schemas_as_others_write_them(written: str) -> None:
    assert field_types(struct_of("x/msg/Top", written)) == {"stamp": Time}


@pytest.mark.parametrize(
    "wrong",
    [
        "int32",
        "Part part",
        schema("Part part", Part="Top again", Top="Part part"),
        schema("Top again"),
        "int32 x\nint32 x",
        "int32 class",
        "int32 _x",
        "int32 ros_type",
        "float64[0] x",
        "float64[99999999999] x",
        "float64[4294967295] x",
        "\0",
        "x" * 2**20 + "y",
        schema("int8 x", **{f"P{n}": "int8 x" for n in range(1001)}),
        schema("P0 x", **{f"P{n}": f"P{n + 1} x" for n in range(60)}, P60="int8 x"),
    ],
    ids=lambda text: text[:20],
)
def test_what_is_no_schema_is_refused(wrong: str) -> None:
    with pytest.raises(MessageError):
        struct_of("x/msg/Top", wrong)


@pytest.mark.parametrize("array", ["", "[2]"])
def test_a_few_lines_that_stand_for_millions_of_values_are_refused(array: str) -> None:
    steps = {f"P{n}": f"P{n + 1}{array} a\nP{n + 1}{array} b" for n in range(40)}
    began = thread_time()
    with pytest.raises(MessageError, match="more values than are read"):
        struct_of("x/msg/Top", schema("P0 x", **steps, P40="int8 x"))
    assert thread_time() - began < 1


PIECES = st.sampled_from(
    [
        "int32 x\n",
        "Part p\n",
        f"{BETWEEN}\nMSG: x/Part\n",
        "string<=3 s\n",
        "[3]",
        "=",
        "\n",
        " ",
        "#",
        '"',
        "K=1\n",
        "Top t\n",
    ]
)


@given(st.lists(PIECES | st.text(max_size=5), max_size=12).map("".join))
def test_any_text_is_a_schema_or_a_message_error(written: str) -> None:
    try:
        found = struct_of("x/msg/Top", written)
    except MessageError:
        return
    assert struct_of("x/msg/Top", text(found)).__struct_fields__ == found.__struct_fields__


def test_constants_come_back() -> None:
    found = struct_of("x/msg/Top", 'string A="it \\"is\\" so"\nbool B=true\nint8 C=-3\nfloat32 D=0.5\nint8 x')
    again = struct_of("x/msg/Top", ros2msg.text(found))
    for name in "ABCD":
        assert getattr(again, name) == getattr(found, name)
