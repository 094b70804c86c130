"""What ROS 2 answers who asks for a type's description: what it is made of, and all types in it.

A node answers so under ~/get_type_description, from Iron on; the hash of a type is that of its description.
(REP-2016; rosidl_generator_type_description)
"""

import re
from collections.abc import Callable, Iterator
from typing import Any

from zteleop.errors import MessageError
from zteleop.interfaces import field_ids
from zteleop.interfaces.declared import declared, parts
from zteleop.interfaces.library import described
from zteleop.interfaces.msg_text import NAME, NO_DEFAULT, PLAIN, Definition, Field
from zteleop.interfaces.structs import struct_of
from zteleop.messages import Message

MOST_TYPES, MOST_FIELDS, LONGEST = 1000, 5000, 255
"""types in a description, fields in all of them, and characters in a name, that are read"""
_PACKAGE = "type_description_interfaces/msg"
_PLACE = "structure_needs_at_least_one_member"
_EMPTY = Field(field_ids.read(3, 0, 0, ""), _PLACE)
"""what a type has that has no field"""
_TYPE = re.compile(rf"{NAME}/(msg|srv|action)/{NAME}")
_FIELD = re.compile(NAME)


def description_of(ros_type: str) -> Message:
    """Return the TypeDescription of a message, service, action, or a part of one, by its name.

    Raises MessageError when there is no such type.
    """
    return _description(ros_type, described)


def description_of_kind(kind: type[Message]) -> Message:
    """Return the TypeDescription of a Struct; raises MessageError where ROS has no word for a part of it."""
    known = {name: declared(part) for name, part in parts(kind).items()}
    return _description(kind.ros_type, known.__getitem__)


def definitions_in(description: Any) -> dict[str, Definition]:
    """Return what a TypeDescription says, by ROS type, that of the described type first.

    Raises MessageError where it says what is none: it came from a stranger.
    """
    all_ = [description.type_description, *description.referenced_type_descriptions]
    fields = sum(len(one.fields) for one in all_)
    if len(all_) > MOST_TYPES or fields > MOST_FIELDS:
        most = f"{MOST_TYPES} types and {MOST_FIELDS} fields"
        raise MessageError(f"expected a description of at most {most}, found {len(all_)} and {fields}")
    found: dict[str, Definition] = {}
    for one in all_:
        if one.type_name in found:
            raise MessageError(f"a description tells twice what {_shown(one.type_name)} is")
        found[_name(one.type_name, _TYPE)] = _definition(one)
    _check_complete(found)
    return found


def _description(ros_type: str, find: Callable[[str], Definition]) -> Message:
    found: dict[str, Definition] = {}
    asked = [ros_type]
    while asked:
        name = asked.pop()
        found[name] = find(name)
        asked += [inner for inner in _nested(found[name]) if inner not in found]
    first, *others = (_individual(found[name]) for name in (ros_type, *sorted(found.keys() - {ros_type})))
    return _made("TypeDescription", type_description=first, referenced_type_descriptions=others)


def _nested(found: Definition) -> Iterator[str]:
    yield from (field.type.name for field in found.fields if field.type.name not in PLAIN)


def _individual(found: Definition) -> Message:
    fields = [_field(field) for field in found.fields or (_EMPTY,)]
    return _made("IndividualTypeDescription", type_name=found.ros_type, fields=fields)


def _field(field: Field) -> Message:
    kind = _made("FieldType", **field_ids.told(field.type)._asdict())
    default = "" if field.default is NO_DEFAULT else str(field.default)
    return _made("Field", name=field.name, type=kind, default_value=default)


def _made(leaf: str, **values: Any) -> Message:
    return struct_of(f"{_PACKAGE}/{leaf}")(**values)


def _definition(one: Any) -> Definition:
    try:
        fields = [
            Field(field_ids.read(*_values(field.type)), _name(field.name, _FIELD)) for field in one.fields
        ]
    except MessageError as error:
        raise MessageError(f"{_shown(one.type_name)}: {error}") from None
    if len({field.name for field in fields}) < len(fields):
        raise MessageError(f"{_shown(one.type_name)} has two fields of one name")
    return Definition(one.type_name, () if fields == [_EMPTY] else tuple(fields), ())


def _values(kind: Any) -> tuple[int, int, int, str]:
    return kind.type_id, kind.capacity, kind.string_capacity, kind.nested_type_name


def _name(text: str, form: re.Pattern[str]) -> str:
    if len(text) > LONGEST or not form.fullmatch(text):
        raise MessageError(f"{_shown(text)} cannot be a name in a description")
    return text


def _check_complete(found: dict[str, Definition]) -> None:
    for one in found.values():
        for name in _nested(one):
            if name not in found:
                raise MessageError(f"a description does not tell what {_shown(name)} in {one.ros_type} is")


def _shown(name: str) -> str:
    return f"{name!r:.80}"
