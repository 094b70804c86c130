from contextlib import suppress
from typing import Annotated, Any, ClassVar

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.errors import MessageError
from zteleop.interfaces.foreign import struct_of
from zteleop.interfaces.schema import fingerprint, schema
from zteleop.messages import MESSAGES, CompressedImage, Message, Odometry, ParameterDescriptor, Pwm, Twist
from zteleop.messages.message import field_types

ANYTHING = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(max_size=8),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(
            st.sampled_from(["$ref", "$defs", "properties", "type", "items", "enum", "anyOf", "T"]),
            inner,
            max_size=4,
        )
    ),
)


def travelled(kind: type[Message]) -> Any:
    return msgspec.json.decode(msgspec.json.encode(schema(kind, kind.ros_type)))


def test_every_message_that_travels_as_a_schema_arrives_as_the_same() -> None:
    for kind in MESSAGES.values():
        found = struct_of(travelled(kind))
        assert found is not kind
        assert (found.ros_type, found.__name__) == (kind.ros_type, kind.__name__)
        assert found.__struct_fields__ == kind.__struct_fields__
        assert fingerprint(found) == fingerprint(kind), kind.ros_type


def test_a_type_with_defaults_arrives_as_the_same_and_agrees_with_itself() -> None:
    class Leaf(Message):
        ros_type: ClassVar[str] = "acme_msgs/msg/Leaf"

        size: float = 1.0

    class Tree(Message):
        ros_type: ClassVar[str] = "acme_msgs/msg/Tree"

        default: float
        leaf: Leaf
        leaves: list[Leaf] = []
        bare: bool = False
        first: Leaf = msgspec.field(default_factory=Leaf)
        height: int | None = None

    assert fingerprint(struct_of(travelled(Tree))) == fingerprint(Tree)
    assert "default" in struct_of(travelled(Tree)).__struct_fields__


def test_its_zero_and_bounds_are_the_same() -> None:
    assert msgspec.json.encode(struct_of(travelled(Odometry)).zero()) == msgspec.json.encode(Odometry.zero())
    with pytest.raises(msgspec.ValidationError, match="32767"):
        msgspec.json.decode(b'{"steering_ticks": 40000, "throttle_ticks": 0}', type=struct_of(travelled(Pwm)))
    values = msgspec.to_builtins(ParameterDescriptor.zero()) | {"integer_range": [1, 2]}
    with pytest.raises(msgspec.ValidationError, match="length"):
        msgspec.convert(values, struct_of(travelled(ParameterDescriptor)))


def test_it_is_no_message_that_everybody_knows() -> None:
    before = dict(MESSAGES)
    struct_of(travelled(Twist))
    assert before == MESSAGES


def one(**part: object) -> dict[str, object]:
    return {"$ref": "#/$defs/T", "$defs": {"T": {"properties": {"x": {"type": "number"}}, **part}}}


@pytest.mark.parametrize(
    ("found", "words"),
    [
        (None, "expected the JSON Schema of a message"),
        ({}, "expected the JSON Schema of a message"),
        ({"$ref": "#/$defs/T"}, "a schema without 'T'"),
        (one(properties={"x": {"$ref": "#/$defs/T"}}), "or one within itself"),
        (one(properties={"a b": {"type": "number"}}), "'a b' cannot be the name of a field"),
        (one(properties={"class": {"type": "number"}}), "'class' cannot be the name of a field"),
        (one(properties={"__class__": {"type": "number"}}), "'__class__' cannot be"),
        (one(properties={f"x{n}": {} for n in range(1001)}), "expected at most 1000 fields in T"),
        ({**one(), "$defs": {str(n): {} for n in range(101)}}, "at most 100 parts, found 101"),
    ],
)
def test_what_describes_no_message_is_refused(found: object, words: str) -> None:
    with pytest.raises(MessageError) as error:
        struct_of(found)
    assert words in str(error.value)


@given(ANYTHING)
def test_anything_is_a_message_or_a_message_error(found: object) -> None:
    try:
        kind = struct_of(found)
    except MessageError:
        return
    assert issubclass(kind, Message)


@given(st.dictionaries(st.text(max_size=5), ANYTHING, max_size=5))
def test_any_fields_are_a_message_or_a_message_error(fields: dict[str, object]) -> None:
    with suppress(MessageError):
        assert issubclass(struct_of(one(properties=fields)), Message)


def with_fields(fields: Any, **parts: Any) -> Any:
    return {"$ref": "T", "$defs": {"T": {"properties": fields}, **parts}}


def laughs(depth: int, width: int) -> Any:
    parts = {
        f"P{n}": {"properties": {f"f{i}": {"$ref": f"P{n + 1}"} for i in range(width)}} for n in range(depth)
    }
    return with_fields({"a": {"$ref": "P0"}}, **parts, **{f"P{depth}": {"properties": {}}})


def nested(depth: int) -> Any:
    field: dict[str, Any] = {"type": "number"}
    for _ in range(depth):
        field = {"type": "array", "items": field}
    return with_fields({"a": field})


ITSELF = {"type": "array", "items": {"$ref": "T"}}


@pytest.mark.parametrize(
    "bomb",
    [
        laughs(15, 20),
        nested(900),
        with_fields({"a": {"type": "array", "items": {"type": "number"}, "minItems": 10**9}}),
        with_fields({"a": ITSELF}),
        with_fields({"a": {}}),
    ],
    ids=["laughs", "lists in lists", "a long list", "itself", "of no type"],
)
def test_a_type_of_which_nobody_can_make_a_message_is_refused(bomb: Any) -> None:
    with pytest.raises(MessageError, match=r"values is none|deep|within itself|not the schema"):
        struct_of(bomb)


@pytest.mark.parametrize("name", ["ros_type", "zero", "__init__", "x" * 10_000 + "-"])
def test_a_field_cannot_be_called_what_a_message_has_for_itself(name: str) -> None:
    with pytest.raises(MessageError, match="cannot be the name of a field") as error:
        struct_of(with_fields({name: {"type": "number"}}))
    assert len(str(error.value)) < 200


def test_a_text_of_least_length_has_a_zero_all_the_same() -> None:
    assert struct_of(with_fields({"a": {"type": "string", "minLength": 5}})).zero()


def test_bytes_stay_bytes() -> None:
    there = struct_of(schema(CompressedImage, CompressedImage.ros_type))
    assert field_types(there)["data"] is bytes
    assert fingerprint(there) == fingerprint(CompressedImage)


class Uuid(Message):
    ros_type: ClassVar[str] = "unique_identifier_msgs/msg/Uuid"

    uuid: Annotated[bytes, msgspec.Meta(min_length=16, max_length=16)]


def test_a_bound_of_bytes_is_not_taken_for_that_of_their_text() -> None:
    found = struct_of(schema(Uuid, Uuid.ros_type))
    assert field_types(found)["uuid"] is bytes
    sixteen = bytes(range(16))
    read: Any = msgspec.json.decode(msgspec.json.encode(Uuid(sixteen)), type=found)
    assert read.uuid == sixteen
