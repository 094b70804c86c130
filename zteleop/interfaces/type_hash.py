"""The hash by which ROS 2 tells types apart: two who write and read a topic meet only where it is the same.

It is that of a type's description as JSON, without comments, constants and defaults. (REP-2016, RIHS01)
"""

import json
from functools import cache
from hashlib import sha256
from typing import Any

from zteleop.errors import MessageError
from zteleop.interfaces.told import struct_told
from zteleop.interfaces.type_description import definitions_in, description_of, description_of_kind
from zteleop.messages import Message

PREFIX = "RIHS01_"


@cache
def hash_of(ros_type: str) -> str:
    """Return the hash of a message, service or action, or of a part of one, by its name.

    Raises MessageError when there is no such type.
    """
    return rihs01(description_of(ros_type))


@cache
def hash_of_kind(kind: type[Message]) -> str:
    """Return the hash of a Struct; raises MessageError where ROS has no word for a part of it."""
    return rihs01(description_of_kind(kind))


def rihs01(description: Any) -> str:
    """Return the hash of a TypeDescription."""
    told = {
        "type_description": _individual(description.type_description),
        "referenced_type_descriptions": [
            _individual(one) for one in description.referenced_type_descriptions
        ],
    }
    return PREFIX + sha256(json.dumps(told).encode()).hexdigest()


def struct_described(description: Any, type_hash: str, ros_type: str = "") -> type[Message]:
    """Return the Struct of a type that somebody describes, or of one within it, such as a service's request.

    Raises MessageError when the description is none, or not the one with the hash that was promised.
    """
    if (found := rihs01(description)) != type_hash:
        raise MessageError(f"expected the description with the hash {type_hash:.80}, found {found}")
    told = definitions_in(description)
    asked = ros_type or next(iter(told))
    if asked not in told:
        raise MessageError(f"the description of {next(iter(told))} does not tell what {asked:.80} is")
    return struct_told(asked, told)


def _individual(one: Any) -> dict[str, Any]:
    return {"type_name": one.type_name, "fields": [_field(field) for field in one.fields]}


def _field(field: Any) -> dict[str, Any]:
    kind = field.type
    told = {
        "type_id": kind.type_id,
        "capacity": kind.capacity,
        "string_capacity": kind.string_capacity,
        "nested_type_name": kind.nested_type_name,
    }
    return {"name": field.name, "type": told}
