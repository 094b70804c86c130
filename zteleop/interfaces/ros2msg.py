"""The schema that a recording carries for a type: the text of its .msg file, and of those within it.

MCAP calls it `ros2msg`: the texts follow one another, each but the first after a line of "=" and its name.
"""

import re
from collections.abc import Iterator
from functools import cache

from zteleop.errors import MessageError
from zteleop.interfaces.declared import declared, parts
from zteleop.interfaces.msg_text import Constant, Definition, parse_message
from zteleop.interfaces.told import struct_told
from zteleop.messages import Message

ENCODING = "ros2msg"
BETWEEN = "=" * 80
LONGEST, MOST = 2**20, 1000
"""characters of a schema, and types in it, that are read"""
_SPLIT = re.compile(r"^={10,}[ \t]*\r?\n[ \t]*MSG:[ \t]*(\S+)[ \t]*\r?$", re.MULTILINE)


@cache
def text(kind: type[Message]) -> str:
    """Return the schema of a type; raises MessageError where ROS has no word for a part of it."""
    first, *others = (declared(part) for part in parts(kind).values())
    return "\n".join(
        [_text(first), *(f"{BETWEEN}\nMSG: {_short(part.ros_type)}\n{_text(part)}" for part in others)]
    )


def struct_of(ros_type: str, schema: str) -> type[Message]:
    """Return the Struct of a type that a schema describes: our own where it has the same fields.

    Raises MessageError when the schema is none, or of another type.
    """
    return struct_told(ros_type, _parse(ros_type, schema))


def _parse(ros_type: str, schema: str) -> dict[str, Definition]:
    if len(schema) > LONGEST:
        raise MessageError(f"expected a schema of at most {LONGEST} characters, found {len(schema)}")
    first, *rest = _SPLIT.split(schema)
    if len(rest) > 2 * MOST:
        raise MessageError(f"expected a schema of at most {MOST} types, found {len(rest) // 2}")
    found = {ros_type: parse_message(first, ros_type)}
    for short, part in zip(rest[::2], rest[1::2], strict=True):
        name = short if short.count("/") > 1 else short.replace("/", "/msg/")
        found.setdefault(name, parse_message(part, name))
    return found


def _text(found: Definition) -> str:
    return "\n".join(_lines(found))


def _lines(found: Definition) -> Iterator[str]:
    for constant in found.constants:
        yield f"{constant.type.name} {constant.name}={_value(constant)}"
    for field in found.fields:
        yield f"{field.type.text} {field.name}"


def _value(constant: Constant) -> str:
    if isinstance(constant.value, str):
        return '"' + constant.value.replace("\\", "\\\\").replace('"', '\\"') + '"'
    return str(constant.value).lower() if isinstance(constant.value, bool) else str(constant.value)


def _short(ros_type: str) -> str:
    """Return geometry_msgs/Twist for geometry_msgs/msg/Twist."""
    return ros_type.replace("/msg/", "/")
