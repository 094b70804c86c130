from collections.abc import Iterator
from typing import Any

import msgspec

from zteleop.interfaces.schema import DIALECT, fingerprint, parts, schema, text
from zteleop.messages import MESSAGES, Message, Odometry, Pwm, Twist, TwistStamped, Vector3
from zteleop.messages.std import Int16

KEYWORDS = {
    "$defs",
    "$ref",
    "$schema",
    "additionalProperties",
    "anyOf",
    "contentEncoding",
    "default",
    "maxLength",
    "description",
    "discriminator",
    "enum",
    "exclusiveMaximum",
    "exclusiveMinimum",
    "items",
    "maxItems",
    "maximum",
    "minItems",
    "minimum",
    "properties",
    "required",
    "title",
    "type",
    "x-ros-type",
}
"""Of draft 2020-12, with two annotations: `discriminator` is OpenAPI's, `x-ros-type` ours."""
TYPES = {"array", "boolean", "integer", "null", "number", "object", "string"}


def pieces(node: Any) -> Iterator[dict[str, Any]]:
    """Yield every schema in a schema."""
    yield node
    for key in ("properties", "$defs"):
        for part in node.get(key, {}).values():
            yield from pieces(part)
    for part in [*node.get("anyOf", []), *([node["items"]] if "items" in node else [])]:
        yield from pieces(part)


def test_every_message_has_a_schema_of_draft_2020_12() -> None:
    for name, kind in MESSAGES.items():
        made = schema(kind, name)
        assert (made["$schema"], made["title"]) == (DIALECT, name)
        for part in pieces(made):
            assert part.keys() <= KEYWORDS, name
            assert part.get("type", "null") in TYPES, name
            assert "$ref" not in part or part["$ref"].removeprefix("#/$defs/") in made["$defs"], name
        assert made["$ref"] == f"#/$defs/{kind.__name__}"


def test_every_field_is_told_and_required() -> None:
    for name, kind in MESSAGES.items():
        told = schema(kind, name)["$defs"][kind.__name__]
        assert told["type"] == "object", name
        assert list(told["properties"]) == told["required"] == list(kind.__struct_fields__), name


def test_what_a_message_is_made_of_is_told_once() -> None:
    assert set(schema(Twist, "t")["$defs"]) == {"Twist", "Vector3"}
    covariance = schema(Odometry, "o")["$defs"]["PoseWithCovariance"]["properties"]["covariance"]
    assert (covariance["minItems"], covariance["maxItems"]) == (36, 36)


def test_the_bounds_of_a_number_are_told() -> None:
    ticks = schema(Pwm, "p")["$defs"]["Pwm"]["properties"]["throttle_ticks"]
    assert (ticks["type"], ticks["minimum"], ticks["exclusiveMaximum"]) == ("integer", -(2**15), 2**15)


def test_a_file_is_the_schema_always_in_the_same_order() -> None:
    made = text(Twist, "geometry_msgs/msg/Twist")
    assert msgspec.json.decode(made) == schema(Twist, "geometry_msgs/msg/Twist")
    assert made.endswith("}\n")
    keys = [line.split('"')[1] for line in made.splitlines() if line.startswith('  "')]
    assert keys == sorted(keys)


def test_each_message_in_a_schema_says_its_ros_type() -> None:
    told = schema(Twist, "t")["$defs"]
    assert {name: part["x-ros-type"] for name, part in told.items()} == {
        "Twist": "geometry_msgs/msg/Twist",
        "Vector3": "geometry_msgs/msg/Vector3",
    }
    assert parts(Twist) == {Twist, Vector3}


def test_a_fingerprint_is_of_the_fields_and_not_of_the_words() -> None:
    class Reworded(Message):
        """Said in other words."""

        ros_type = Pwm.ros_type

        steering_ticks: Int16
        throttle_ticks: Int16

    Reworded.__name__ = Reworded.__qualname__ = "Pwm"
    assert fingerprint(Reworded) == fingerprint(Pwm)
    prints = {fingerprint(kind) for kind in MESSAGES.values()}
    assert len(prints) == len(MESSAGES)
    assert all(len(one) == 8 and int(one, 16) >= 0 for one in prints)


def test_a_field_named_like_a_word_of_the_schema_counts() -> None:
    class Titled(Message):
        ros_type = "x/msg/Titled"

        title: str

    class Untitled(Message):
        ros_type = "x/msg/Titled"

        description: str

    Untitled.__name__ = Untitled.__qualname__ = "Titled"
    assert fingerprint(Titled) != fingerprint(Untitled)


def test_the_fields_within_fields_count() -> None:
    assert fingerprint(Twist) != fingerprint(TwistStamped)
