"""What a message holds where nobody says otherwise: ROS 2's defaults, else zeros."""

from collections.abc import Mapping
from typing import Any

from zteleop.interfaces.declared import declared, parts
from zteleop.interfaces.msg_text import NO_DEFAULT
from zteleop.messages import Message


def with_defaults(kind: type[Message], values: object) -> object:
    """Return the values of a message, and where one is left out its default, if it has one."""
    if not isinstance(values, Mapping):
        return values
    found: dict[str, Any] = dict(values)
    inner = parts(kind)
    for field in declared(kind).fields:
        if field.name not in found and field.default is not NO_DEFAULT:
            found[field.name] = list(field.default) if field.type.array else field.default
        elif field.type.name in inner and not field.type.array:
            whole = with_defaults(inner[field.type.name], found.get(field.name, {}))
            if whole or field.name in found:
                found[field.name] = whole
    return found
