"""How messages of a type are told to ROS's tools: as ROS 2 does, CDR with its own text, which each reads.

A type of which ROS has no word for a part is told as JSON with its JSON Schema.
"""

from collections.abc import Callable
from functools import cache
from typing import Any

import msgspec

from zteleop.errors import MessageError
from zteleop.interfaces import cdr, ros2msg
from zteleop.interfaces.channel_form import Form as Form
from zteleop.interfaces.schema import schema
from zteleop.messages import Message
from zteleop.messages.message import plain

CDR, JSON = "cdr", "json"
JSON_SCHEMA = "jsonschema"
_DEEPEST = 50

Write = Callable[[Message], bytes]


@cache
def form_of(kind: type[Message]) -> Form:
    """Return how messages of a type are told."""
    try:
        cdr.encoder(kind)
        return Form(kind.ros_type, CDR, ros2msg.ENCODING, ros2msg.text(kind).encode())
    except MessageError:
        return json_form_of(kind)


@cache
def json_form_of(kind: type[Message]) -> Form:
    """Return how messages of a type are told as JSON."""
    text = msgspec.json.encode(_inlined(schema(kind, kind.ros_type)))
    return Form(kind.ros_type, JSON, JSON_SCHEMA, text)


@cache
def writer_of(kind: type[Message]) -> Write:
    """Return what turns messages of a type into the bytes that its form tells of."""
    if form_of(kind).encoding == CDR:
        return cdr.encoder(kind)
    return lambda message: msgspec.json.encode(plain(message))


def _inlined(found: dict[str, Any]) -> dict[str, Any]:
    """Return a schema without references, which not every tool follows."""
    parts = found["$defs"]

    def inline(value: Any, depth: int) -> Any:
        if isinstance(value, dict):
            if "$ref" in value and depth < _DEEPEST:
                return inline(parts[value["$ref"].rpartition("/")[2]], depth + 1)
            return {key: inline(item, depth) for key, item in value.items() if key != "$defs"}
        return [inline(item, depth) for item in value] if isinstance(value, list) else value

    return {**inline({"$ref": found["$ref"]}, 0), "title": found["title"]}
