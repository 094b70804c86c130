"""JSON Schema of messages and settings, for every other language and for editors."""

from collections.abc import Iterator
from functools import cache
from hashlib import sha256
from typing import Any, get_args

import msgspec

from zteleop.messages import Message
from zteleop.messages.message import field_types

DIALECT = "https://json-schema.org/draft/2020-12/schema"
ROS_TYPE = "x-ros-type"
_BESIDE = ("title", "description", "default", "required")
"""what a schema says besides which fields there are"""


def schema(kind: type, title: str) -> dict[str, Any]:
    """Return the JSON Schema of a Struct; each message in it says its ROS type."""
    (reference,), components = msgspec.json.schema_components([kind], ref_template="#/$defs/{name}")
    if issubclass(kind, Message):
        for part in parts(kind):
            components[part.__name__][ROS_TYPE] = part.ros_type
    return {"$schema": DIALECT, "title": title, **reference, "$defs": components}


def text(kind: type, title: str) -> str:
    """Return the schema as it is kept in a file."""
    return (
        msgspec.json.format(msgspec.json.encode(schema(kind, title), order="sorted"), indent=2).decode()
        + "\n"
    )


@cache
def fingerprint(kind: type[Message]) -> str:
    """Return eight hexadecimal digits that two messages share when their fields are the same.

    What a field is by default is not among them: whoever rebuilds a type from its schema says every field.
    """
    found = _fields_alone(schema(kind, kind.ros_type))
    return sha256(msgspec.json.encode(found, order="sorted")).hexdigest()[:8]


def parts(kind: type[Message]) -> set[type[Message]]:
    """Return a message and the messages in it."""
    return {kind}.union(
        *(parts(part) for field in field_types(kind).values() for part in _messages_in(field))
    )


def _messages_in(field: Any) -> Iterator[type[Message]]:
    if isinstance(field, type) and issubclass(field, Message):
        yield field
    for argument in get_args(field):
        yield from _messages_in(argument)


def _fields_alone(value: Any) -> Any:
    if isinstance(value, dict) and "properties" in value:
        fields = {name: _fields_alone(field) for name, field in value["properties"].items()}
        return {**{k: v for k, v in value.items() if k not in _BESIDE}, "properties": fields}
    if isinstance(value, dict):
        return {key: _fields_alone(item) for key, item in value.items() if key not in _BESIDE}
    return value
