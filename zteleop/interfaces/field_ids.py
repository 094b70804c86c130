"""The numbers by which a description of a type, in its FieldType, tells what a field holds. (REP-2016)"""

from typing import Any, Literal, NamedTuple

from zteleop.errors import MessageError
from zteleop.interfaces.msg_text import MOST, Type

NESTED = 1
_STRINGS = {"string": 17, "wstring": 18}
_BOUNDED = 4
"""more than that of a string, where it has a bound"""
_NAMES = {
    "int8": 2,
    "uint8": 3,
    "int16": 4,
    "uint16": 5,
    "int32": 6,
    "uint32": 7,
    "int64": 8,
    "uint64": 9,
    "float32": 10,
    "float64": 11,
    "bool": 15,
    "byte": 16,
    **_STRINGS,
}
_ARRAYS: tuple[Literal["", "fixed", "bounded", "unbounded"], ...] = ("", "fixed", "bounded", "unbounded")
_STEP = 48
"""from the number of one to that of an array of each kind"""
_CHAR = 13
_TYPES = {number: name for name, number in _NAMES.items()} | {_CHAR: "char"}


class FieldType(NamedTuple):
    """What a description tells of a field's type, in its own order."""

    type_id: int
    capacity: int = 0
    string_capacity: int = 0
    nested_type_name: str = ""


def told(kind: Type) -> FieldType:
    """Return how a description tells of a type; ROS 2's char of a .msg file is a uint8."""
    name = "uint8" if kind.name == "char" else kind.name
    number = _NAMES.get(name, NESTED) + (_BOUNDED if kind.bound else 0)
    nested = name if number == NESTED else ""
    step = _STEP * _ARRAYS.index(kind.array)
    return FieldType(number + step, kind.length or 0, kind.bound or 0, nested)


def read(type_id: int, capacity: int, string_capacity: int, nested: str) -> Type:
    """Return the type that a description tells of; raises MessageError where there is none such here."""
    step, number = divmod(type_id, _STEP)
    if step >= len(_ARRAYS):
        raise MessageError(f"no type of a field has the number {type_id}")
    bound = None
    if number - _BOUNDED in _STRINGS.values():
        number, bound = number - _BOUNDED, _size(string_capacity)
    name: Any = nested if number == NESTED and "/" in nested else _TYPES.get(number)
    if not name:
        raise MessageError(f"a field of the type with the number {type_id} is not read here")
    length = _size(capacity) if _ARRAYS[step] in ("fixed", "bounded") else None
    return Type(name, bound, _ARRAYS[step], length)


def _size(size: int) -> int:
    if not 0 < size <= MOST:
        raise MessageError(f"expected a length from 1 to {MOST}, found {size}")
    return size
