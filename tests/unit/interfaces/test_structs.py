from pathlib import Path
from typing import Annotated, Any

import msgspec
import pytest
from msgspec import Meta
from unit.interfaces.test_library import ALL

from zteleop.errors import MessageError
from zteleop.interfaces import library, structs
from zteleop.interfaces.definition import definition as text_of
from zteleop.interfaces.library import add_folder, definition
from zteleop.interfaces.msg_text import PLAIN
from zteleop.interfaces.schema import fingerprint
from zteleop.interfaces.structs import annotations_of, struct_of
from zteleop.messages import MESSAGES, Message, Twist, Vector3
from zteleop.messages.message import field_types
from zteleop.messages.std import Header, Int8, Int16, Int32, Int64, UInt8, UInt16, UInt32, UInt64


@pytest.fixture
def soil(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return how a message garden_msgs/msg/Soil, and others, are made of a text."""
    monkeypatch.setattr(library, "_theirs", {})
    monkeypatch.setattr(structs, "_made", {})

    def make(text: str, **others: str) -> type[Message]:
        definition.cache_clear()
        library._parse.cache_clear()
        for name, lines in {"Soil": text, **others}.items():
            path = tmp_path / "garden_msgs" / "msg" / f"{name}.msg"
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(lines)
        add_folder(tmp_path)
        return struct_of("garden_msgs/msg/Soil")

    return make


def test_our_own_messages_are_what_ros_says() -> None:
    for ros_type in MESSAGES.keys() & set(ALL):
        said = annotations_of(definition(ros_type))
        assert [*said.items()] == [*field_types(MESSAGES[ros_type]).items()], ros_type


def test_every_message_of_our_own_is_one_that_ros_has_or_is_zteleops() -> None:
    assert {name.partition("/")[0] for name in MESSAGES.keys() - set(ALL)} == {"zteleop_msgs"}


def test_our_own_constants_are_what_ros_says() -> None:
    for ros_type in MESSAGES.keys() & set(ALL):
        said = {constant.name: constant.value for constant in definition(ros_type).constants}
        own = vars(MESSAGES[ros_type])
        assert {name: own[name] for name in said if name in own}.items() <= said.items(), ros_type


def test_every_type_of_the_library_is_a_struct() -> None:
    for ros_type in ALL:
        kind = struct_of(ros_type)
        assert kind.ros_type == ros_type
        assert struct_of(ros_type) is kind, ros_type
        assert [*kind.__struct_fields__] == [field.name for field in definition(ros_type).fields], ros_type
        assert kind.__struct_defaults__ == ()
        assert fingerprint(kind)
        msgspec.json.Decoder(kind)


def test_our_own_struct_is_the_struct() -> None:
    assert struct_of("geometry_msgs/msg/Twist") is Twist
    assert struct_of("zteleop_msgs/msg/Pwm") is MESSAGES["zteleop_msgs/msg/Pwm"]


def test_and_is_so_within_others() -> None:
    assert field_types(struct_of("geometry_msgs/msg/Accel")) == {"linear": Vector3, "angular": Vector3}


def test_whoever_is_within_several_is_the_same_struct() -> None:
    info = field_types(struct_of("action_msgs/srv/CancelGoal_Request"))["goal_info"]
    assert info is struct_of("action_msgs/msg/GoalInfo")
    assert field_types(struct_of("action_msgs/msg/GoalStatus"))["goal_info"] is info


def test_it_is_called_by_the_end_of_its_type() -> None:
    assert struct_of("geometry_msgs/msg/Accel").__name__ == "Accel"
    assert struct_of("example_interfaces/srv/AddTwoInts_Request").__name__ == "AddTwoInts_Request"


@pytest.mark.parametrize(
    ("text", "annotation"),
    [
        ("bool", bool),
        ("byte", UInt8),
        ("char", UInt8),
        ("int8", Int8),
        ("int16", Int16),
        ("int32", Int32),
        ("int64", Int64),
        ("uint8", UInt8),
        ("uint16", UInt16),
        ("uint32", UInt32),
        ("uint64", UInt64),
        ("float32", float),
        ("float64", float),
        ("string", str),
        ("wstring", str),
        ("string<=3", Annotated[str, Meta(max_length=3)]),
        ("string<=3[]", list[Annotated[str, Meta(max_length=3)]]),
        ("int16[]", list[Int16]),
        ("byte[]", list[UInt8]),
        ("uint8[]", bytes),
        ("uint8[<=9]", Annotated[bytes, Meta(max_length=9)]),
        ("uint8[16]", Annotated[bytes, Meta(min_length=16, max_length=16)]),
        ("float32[9]", Annotated[list[float], Meta(min_length=9, max_length=9)]),
        ("std_msgs/Header[<=2]", Annotated[list[Header], Meta(max_length=2)]),
    ],
)
def test_a_field_is_annotated_as_ours_are(soil: Any, text: str, annotation: Any) -> None:
    assert field_types(soil(f"{text} x")) == {"x": annotation}


def test_every_plain_type_has_an_annotation() -> None:
    assert structs.PLAIN.keys() == PLAIN


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("int8 x", 128),
        ("byte x", -1),
        ("string<=2 x", "abc"),
        ("int8[2] x", [1]),
        ("int8[<=2] x", [1, 2, 3]),
        ("uint8[2] x", b"abc"),
        ("int8[] x", [300]),
    ],
)
def test_whatever_is_out_of_range_is_refused(soil: Any, text: str, value: Any) -> None:
    with pytest.raises(msgspec.ValidationError, match=r"at `\$.x"):
        msgspec.convert({"x": value}, soil(text))


def test_it_has_its_constants(soil: Any) -> None:
    kind = soil("int8 DRY=-1\nstring NAME=mud\nfloat64 wetness")
    assert (kind.DRY, kind.NAME) == (-1, "mud")
    assert kind.__struct_fields__ == ("wetness",)
    assert text_of(kind) == "int32 DRY=-1\nfloat64 wetness"


def test_it_has_no_defaults(soil: Any) -> None:
    with pytest.raises(msgspec.ValidationError, match="wetness"):
        msgspec.convert({}, soil("float64 wetness 0.5"))


def test_it_is_no_message_that_everybody_knows(soil: Any) -> None:
    before = dict(MESSAGES)
    soil("float64 wetness")
    assert before == MESSAGES


def test_a_message_within_itself_is_none(soil: Any) -> None:
    with pytest.raises(
        MessageError, match="garden_msgs/msg/Soil in garden_msgs/msg/Pot in garden_msgs/msg/Soil"
    ):
        soil("Pot pot", Pot="Soil[] soil")


def test_nor_is_one_too_deep_in_others(soil: Any) -> None:
    pots = {f"Pot{number}": f"Pot{number + 1} pot" for number in range(2000)}
    with pytest.raises(MessageError, match="50 deep in others"):
        soil("Pot0 pot", **pots)


def test_a_message_that_is_nowhere_is_told(soil: Any) -> None:
    with pytest.raises(MessageError, match="no interface 'garden_msgs/msg/Pot'"):
        soil("Pot pot")


@pytest.mark.parametrize("name", ["from", "zero", "ros_type", "None"])
def test_a_name_that_python_has_not_for_a_field_is_told(soil: Any, name: str) -> None:
    for text in (f"int8 {name}", f"int8 {name}=1"):
        with pytest.raises(MessageError, match=f"'{name}' in garden_msgs/msg/Soil cannot be a name"):
            soil(text)
