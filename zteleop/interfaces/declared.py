"""What ROS would write in a .msg file for a Struct: its fields and constants, in ROS's own types."""

from collections.abc import Mapping
from functools import cache
from typing import Any

from zteleop.errors import MessageError
from zteleop.interfaces.definition import constants_of, field_of
from zteleop.interfaces.msg_text import Constant, Definition, Field, Type, parse_type
from zteleop.interfaces.structs import definition_of
from zteleop.messages import Message
from zteleop.messages.message import field_types

WORDLESS = ("any", "object")
"""what a field of a Struct may be, and ROS has no type for"""


@cache
def declared(kind: type[Message]) -> Definition:
    """Return what a message is made of; raises MessageError where ROS has no word for a part of it."""
    if written := definition_of(kind):
        return written
    package = kind.ros_type.partition("/")[0]
    fields = [Field(_type(annotation, package, name), name) for name, annotation in field_types(kind).items()]
    constants = [Constant(_constant(value), name, value) for name, value in constants_of(kind)]
    return Definition(kind.ros_type, tuple(fields), tuple(constants))


def parts(kind: type[Message]) -> Mapping[str, type[Message]]:
    """Return a message and those within it, by their ROS types, each after what it is in."""
    found: dict[str, type[Message]] = {}
    _collect(kind, found)
    return found


def message_in(annotation: Any, package: str) -> type[Message] | None:
    """Return the message that a field holds, one or an array of them."""
    return field_of(annotation, package).message


def _collect(kind: type[Message], found: dict[str, type[Message]]) -> None:
    if kind.ros_type in found:
        return
    found[kind.ros_type] = kind
    for inner in _within(kind):
        _collect(inner, found)


@cache
def _within(kind: type[Message]) -> list[type[Message]]:
    """Return the messages that the fields of a message hold."""
    package = kind.ros_type.partition("/")[0]
    found = (message_in(annotation, package) for annotation in field_types(kind).values())
    return [inner for inner in found if inner]


def _type(annotation: Any, package: str, name: str) -> Type:
    field = field_of(annotation, package)
    word = field.ros_type.partition("[")[0]
    if word in WORDLESS or "or null" in field.note:
        raise MessageError(f"ROS has no type for the field {name!r}")
    return parse_type(field.ros_type, package)


def _constant(value: Any) -> Type:
    if isinstance(value, bool):
        return Type("bool")
    if isinstance(value, int):
        return Type("uint8" if 0 <= value < 256 else "int32")
    return Type("string" if isinstance(value, str) else "float64")
