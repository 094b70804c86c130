"""What all messages share.

Fields have no defaults, so that a foreign object is an error and never silent zeros;
`Message.zero()` is ROS's default-constructed message. Messages are mutable, as ROS's are.
"""

from collections.abc import Mapping
from functools import cache
from typing import Annotated, Any, ClassVar, Literal, Self, get_args, get_origin, get_type_hints

import msgspec
from msgspec import Meta, Struct


class Message(Struct):
    """A Struct with ROS's own fields, known to ROS as `ros_type`."""

    ros_type: ClassVar[str]

    @classmethod
    def zero(cls) -> Self:
        """Return the message with every number 0, every text and list empty."""
        return cls(**{name: zero_of(kind) for name, kind in field_types(cls).items()})


def plain(value: Any) -> Any:
    """Return a message, or a part of one, as dicts, lists, numbers and texts; bytes stay bytes."""
    return msgspec.to_builtins(value, builtin_types=(bytes,))


@cache
def field_types(kind: type[Struct]) -> Mapping[str, Any]:
    """Return a Struct's fields and their annotations, in order."""
    hints = get_type_hints(kind, include_extras=True)
    return {name: hints[name] for name in kind.__struct_fields__}


def zero_of(kind: Any) -> Any:
    """Return the zero of a field's annotation."""
    origin, arguments = get_origin(kind), get_args(kind)
    if origin is Annotated:
        inner, *metas = arguments
        length = next((m.min_length for m in metas if isinstance(m, Meta) and m.min_length), 0)
        if inner is bytes:
            return bytes(length)
        return [zero_of(get_args(inner)[0]) for _ in range(length)] if length else zero_of(inner)
    if origin is Literal:
        return arguments[0]
    if type(None) in arguments:
        return None
    if isinstance(kind, type) and issubclass(kind, Message):
        return kind.zero()
    return (origin or kind)()
