from time import thread_time
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from unit.interfaces.cdr.values import kinds

from zteleop.errors import MessageError
from zteleop.interfaces import cdr
from zteleop.interfaces.library import described
from zteleop.interfaces.structs import struct_of
from zteleop.interfaces.told import struct_told
from zteleop.interfaces.type_description import (
    MOST_FIELDS,
    MOST_TYPES,
    definitions_in,
    description_of,
    description_of_kind,
)
from zteleop.messages import MESSAGES, Twist, Vector3
from zteleop.messages.message import plain

PACKAGE = "type_description_interfaces/msg"
WHOLE, ONE, FIELD, KIND = (
    struct_of(f"{PACKAGE}/{leaf}")
    for leaf in ("TypeDescription", "IndividualTypeDescription", "Field", "FieldType")
)


def field(name: str, type_id: int, nested: str = "", capacity: int = 0) -> Any:
    made: Any = KIND(type_id=type_id, capacity=capacity, string_capacity=0, nested_type_name=nested)  # type: ignore[call-arg]
    return FIELD(name=name, type=made, default_value="")  # type: ignore[call-arg]


def one(name: str, *fields: Any) -> Any:
    return ONE(type_name=name, fields=[*fields])  # type: ignore[call-arg]


def whole(first: Any, *others: Any) -> Any:
    return WHOLE(type_description=first, referenced_type_descriptions=[*others])  # type: ignore[call-arg]


def test_a_description_tells_each_field_and_all_types_within_sorted() -> None:
    told: Any = plain(description_of("geometry_msgs/msg/TwistStamped"))
    assert told["type_description"]["type_name"] == "geometry_msgs/msg/TwistStamped"
    assert [one["type_name"] for one in told["referenced_type_descriptions"]] == [
        "builtin_interfaces/msg/Time",
        "geometry_msgs/msg/Twist",
        "geometry_msgs/msg/Vector3",
        "std_msgs/msg/Header",
    ]
    assert told["referenced_type_descriptions"][3]["fields"][0] == {
        "name": "stamp",
        "type": {
            "type_id": 1,
            "capacity": 0,
            "string_capacity": 0,
            "nested_type_name": "builtin_interfaces/msg/Time",
        },
        "default_value": "",
    }


@pytest.mark.parametrize(
    ("ros_type", "name", "default"),
    [
        ("geometry_msgs/msg/Quaternion", "w", "1.0"),
        ("rcl_interfaces/msg/ParameterDescriptor", "read_only", "False"),
        ("sensor_msgs/msg/NavSatStatus", "status", "-2"),
        ("std_msgs/msg/Header", "frame_id", ""),
    ],
)
def test_a_default_is_told_in_words(ros_type: str, name: str, default: str) -> None:
    told: Any = description_of(ros_type)
    (found,) = [field for field in told.type_description.fields if field.name == name]
    assert found.default_value == default


def test_an_empty_type_has_the_field_that_stands_for_none_and_comes_back_without() -> None:
    told: Any = description_of("std_msgs/msg/Empty")
    assert [(f.name, f.type.type_id) for f in told.type_description.fields] == [
        ("structure_needs_at_least_one_member", 3)
    ]
    assert definitions_in(told)["std_msgs/msg/Empty"].fields == ()


def test_whole_services_and_actions_are_described_with_all_that_travels() -> None:
    told: Any = description_of("irobot_create_msgs/action/Undock")
    names = [one.type_name for one in told.referenced_type_descriptions]
    assert names == sorted(names)
    assert "irobot_create_msgs/action/Undock_SendGoal_Event" in names
    assert "service_msgs/msg/ServiceEventInfo" in names
    assert description_of("irobot_create_msgs/action/Undock_SendGoal") != told


def test_every_type_comes_back_as_it_is() -> None:
    for kind in kinds():
        told = definitions_in(description_of_kind(kind))
        for ros_type in told:
            if not ros_type.startswith("zteleop_msgs/"):
                shape = [
                    (f.type._replace(name=f.type.name.replace("char", "uint8")), f.name)
                    for f in described(ros_type).fields
                ]
                assert [(f.type, f.name) for f in told[ros_type].fields] == shape, ros_type
        assert kind.ros_type not in MESSAGES or struct_told(kind.ros_type, told) is kind


def test_a_struct_of_an_unknown_type_is_made_of_its_description() -> None:
    told = whole(
        one(
            "garden_msgs/msg/Pot",
            field("soil", 1, "garden_msgs/msg/Soil"),
            field("at", 1, "geometry_msgs/msg/Vector3"),
        ),
        one("garden_msgs/msg/Soil", field("wetness", 11), field("grains", 3 + 48, capacity=2)),
        one("geometry_msgs/msg/Vector3", *(field(name, 11) for name in "xyz")),
    )
    kind = struct_told("garden_msgs/msg/Pot", definitions_in(told))
    assert kind.__struct_fields__ == ("soil", "at")
    zero: Any = kind.zero()
    assert type(zero.at) is Vector3
    assert zero.soil.grains == b"\0\0"
    assert cdr.decode(cdr.encode(zero), kind) == zero


def test_a_description_came_over_the_wire_as_well() -> None:
    told = description_of_kind(Twist)
    again = cdr.decode(cdr.encode(told), type(told))
    assert definitions_in(again) == definitions_in(told)


LONG = "x" * 256
WRONG = {
    "no name": one("", field("x", 11)),
    "a path": one("../../etc/passwd", field("x", 11)),
    "two parts": one("garden_msgs/Soil", field("x", 11)),
    "long name": one(f"garden_msgs/msg/{LONG}", field("x", 11)),
    "control": one("garden_msgs/msg/\x1b[2J", field("x", 11)),
    "field of no name": one("a/msg/B", field("", 11)),
    "field with a dot": one("a/msg/B", field("x.y", 11)),
    "field with code": one("a/msg/B", field("x=exit()", 11)),
    "field with a long name": one("a/msg/B", field(LONG, 11)),
    "private field": one("a/msg/B", field("__class__", 11)),
    "keyword": one("a/msg/B", field("class", 11)),
    "ros_type": one("a/msg/B", field("ros_type", 11)),
    "twice": one("a/msg/B", field("x", 11), field("x", 10)),
    "unknown number": one("a/msg/B", field("x", 200)),
    "no capacity": one("a/msg/B", field("x", 11 + 48)),
    "nowhere": one("a/msg/B", field("x", 1, "a/msg/C")),
    "within itself": one("a/msg/B", field("x", 1, "a/msg/B")),
    "within itself, in a list": one("a/msg/B", field("x", 145, "a/msg/B")),
    "large": one("a/msg/B", field("x", 11 + 48, capacity=2**32 - 1)),
}


@pytest.mark.parametrize("wrong", WRONG.values(), ids=WRONG)
def test_what_describes_nothing_is_refused_in_one_line(wrong: Any) -> None:
    with pytest.raises(MessageError) as error:
        struct_told("a/msg/B", definitions_in(whole(wrong)))
    assert len(str(error.value)) < 300
    assert str(error.value).isprintable()


def test_two_descriptions_of_one_type_are_none() -> None:
    two = [one("a/msg/B", field("x", 11)), one("a/msg/B", field("x", 10))]
    with pytest.raises(MessageError, match="tells twice what 'a/msg/B' is"):
        definitions_in(whole(*two))


def test_a_description_that_leaves_out_what_is_within_is_none_though_everybody_knows_it() -> None:
    told: Any = description_of("geometry_msgs/msg/TwistStamped")
    del told.referenced_type_descriptions[0]
    with pytest.raises(MessageError, match="does not tell what 'builtin_interfaces/msg/Time' in std_msgs"):
        definitions_in(told)


def test_of_too_many_types_or_fields_none_is_read() -> None:
    many = [one(f"a/msg/B{n}", field("x", 11)) for n in range(MOST_TYPES)]
    wide = one("a/msg/B", *(field(f"x{n}", 11) for n in range(MOST_FIELDS + 1)))
    for told in (whole(one("a/msg/B", field("x", 11)), *many), whole(wide)):
        with pytest.raises(
            MessageError, match="expected a description of at most 1000 types and 5000 fields"
        ):
            definitions_in(told)


@pytest.mark.parametrize("step", [0, 48])
def test_a_few_types_that_stand_for_millions_of_values_are_refused(step: int) -> None:
    steps = [
        one(f"a/msg/B{n}", *(field(name, 1 + step, f"a/msg/B{n + 1}", 2 if step else 0) for name in "xy"))
        for n in range(40)
    ]
    began = thread_time()
    with pytest.raises(MessageError, match="more values than are read"):
        struct_told("a/msg/B0", definitions_in(whole(*steps, one("a/msg/B40", field("x", 2)))))
    assert thread_time() - began < 1


def test_types_too_deep_in_others_are_refused() -> None:
    steps = [one(f"a/msg/B{n}", field("x", 1, f"a/msg/B{n + 1}")) for n in range(900)]
    with pytest.raises(MessageError, match="50 deep in others"):
        struct_told("a/msg/B0", definitions_in(whole(*steps, one("a/msg/B900", field("x", 2)))))


NAMES = st.sampled_from(["a/msg/B", "a/msg/C", "std_msgs/msg/Header", "geometry_msgs/msg/Vector3", "B", ""])
SIZES = st.sampled_from([0, 1, 3, 2**32, 2**64 - 1])
KINDS = st.builds(
    KIND,
    type_id=st.one_of(st.integers(0, 255), st.sampled_from([1, 11, 49, 145])),
    capacity=SIZES,
    string_capacity=SIZES,
    nested_type_name=NAMES,
)
FIELDS = st.builds(
    FIELD, name=st.sampled_from(["x", "y", "z"]) | st.text(max_size=4), type=KINDS, default_value=st.text()
)
ONES = st.builds(ONE, type_name=NAMES, fields=st.lists(FIELDS, max_size=4))


@given(st.builds(WHOLE, type_description=ONES, referenced_type_descriptions=st.lists(ONES, max_size=3)))
def test_any_description_is_a_struct_or_a_message_error(told: Any) -> None:
    try:
        found = definitions_in(told)
        kind = struct_told(next(iter(found)), found)
        read = cdr.decoder(kind)
    except MessageError:
        return
    again = definitions_in(description_of_kind(kind))
    assert [f.name for f in again[kind.ros_type].fields] == [f.name for f in found[kind.ros_type].fields]
    zero = kind.zero()
    assert read(cdr.encode(zero)) == zero
