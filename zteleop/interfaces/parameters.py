"""Values of parameters, from Python to ROS's ParameterValue and back."""

from typing import Any

from zteleop.errors import MessageError
from zteleop.messages import ParameterValue

Value = bool | int | float | str | list[bool] | list[int] | list[float] | list[str]
_FIELDS = {
    ParameterValue.BOOL: ("bool_value", "Boolean", bool),
    ParameterValue.INTEGER: ("integer_value", "Integer", int),
    ParameterValue.DOUBLE: ("double_value", "Double", float),
    ParameterValue.STRING: ("string_value", "String", str),
    ParameterValue.BYTE_ARRAY: ("byte_array_value", "Byte", bytes),
    ParameterValue.BOOL_ARRAY: ("bool_array_value", "Boolean", bool),
    ParameterValue.INTEGER_ARRAY: ("integer_array_value", "Integer", int),
    ParameterValue.DOUBLE_ARRAY: ("double_array_value", "Double", float),
    ParameterValue.STRING_ARRAY: ("string_array_value", "String", str),
}
"""by type: the field that counts, what ROS's command line calls it, and Python's type"""
_SUCH_AS = {
    ParameterValue.BOOL: "true",
    ParameterValue.INTEGER: "3",
    ParameterValue.DOUBLE: "0.3",
    ParameterValue.BOOL_ARRAY: "[true, false]",
    ParameterValue.INTEGER_ARRAY: "[1, 2]",
    ParameterValue.DOUBLE_ARRAY: "[0.1, 0.2]",
    ParameterValue.STRING_ARRAY: "[left, right]",
}
"""what to write, of the types that not every text is"""


def kind_of(value: Value) -> int:
    """Return the type of a value; raises MessageError for what is none. An empty list is of texts."""
    if isinstance(value, list):
        kinds = {kind_of(item) for item in value} or {ParameterValue.STRING}
        if kinds == {ParameterValue.INTEGER, ParameterValue.DOUBLE}:
            kinds = {ParameterValue.DOUBLE}
        if len(kinds) == 1 and (kind := kinds.pop()) <= ParameterValue.STRING:
            return kind + ParameterValue.BYTE_ARRAY
    for kind, (_, _, python) in _FIELDS.items():
        if type(value) is python and kind <= ParameterValue.STRING:
            return kind
    raise MessageError(
        f"a parameter is a truth value, number, text or a list of one of these; found {value!r:.80}"
    )


def from_python(value: Value) -> ParameterValue:
    """Return a value as it travels; raises MessageError for what is none."""
    kind = kind_of(value)
    found = ParameterValue.zero()
    found.type = kind
    if kind == ParameterValue.DOUBLE_ARRAY and isinstance(value, list):
        value = [float(item) for item in value]
    setattr(found, _FIELDS[kind][0], value)
    return found


def to_python(value: ParameterValue) -> Any:
    """Return the field that counts; None where nothing is set."""
    return getattr(value, _FIELDS[value.type][0]) if value.type in _FIELDS else None


def type_words(kind: int) -> str:
    """Return what `ros2 param` calls a type: `double`, `integer array`."""
    if kind not in _FIELDS:
        return "not set"
    return _FIELDS[kind][1].lower() + (" array" if kind >= ParameterValue.BYTE_ARRAY else "")


def sentence(value: ParameterValue) -> str:
    """Return a value as `ros2 param get` says it."""
    if value.type not in _FIELDS:
        return "Parameter not set."
    many = "values are" if value.type >= ParameterValue.BYTE_ARRAY else "value is"
    return f"{_FIELDS[value.type][1]} {many}: {to_python(value)}"


def fit(value: Any, kind: int) -> Any:
    """Return a value as one of a type: a whole number is a double too.

    Raises MessageError when it is of another.
    """
    if kind == ParameterValue.DOUBLE and type(value) is int:
        return float(value)
    if kind == ParameterValue.DOUBLE_ARRAY and kind_of(value) == ParameterValue.INTEGER_ARRAY:
        return [float(item) for item in value]
    if isinstance(value, list) and not value and kind >= ParameterValue.BYTE_ARRAY:
        return value
    if kind_of(value) != kind:
        example = f", such as {_SUCH_AS[kind]}" if kind in _SUCH_AS else ""
        raise MessageError(f"expected {type_words(kind)}{example}, found {value!r:.80}")
    return value
