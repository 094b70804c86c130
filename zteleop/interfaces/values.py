"""From values that a person wrote to a message."""

from collections.abc import Mapping
from difflib import get_close_matches
from typing import Any, TypeVar, get_args, get_origin

import msgspec

from zteleop.errors import MessageError
from zteleop.messages import Message
from zteleop.messages.message import field_types, zero_of

M = TypeVar("M", bound=Message)


def fill(kind: type[M], values: object) -> M:
    """Return a message with these fields, and zeros for the others, as `ros2 topic pub` does.

    Raises MessageError with the path of what does not fit, and the nearest names.
    """
    filled = _fill(kind, {} if values is None else values, kind.__name__)
    try:
        return msgspec.convert(filled, kind)
    except (msgspec.ValidationError, UnicodeEncodeError) as error:  # the latter of half a surrogate pair
        raise MessageError(f"not a {kind.__name__}: {error}") from None


def _fill(kind: Any, values: object, path: str) -> Any:
    if isinstance(kind, type) and issubclass(kind, Message):
        return _fill_fields(kind, values, path)
    if get_origin(kind) is list and isinstance(values, list):
        (item,) = get_args(kind)
        return [_fill(item, value, f"{path}[{index}]") for index, value in enumerate(values)]
    return values


def _example(kind: Any) -> str:
    """Return how the first field of a type is written, down to a value."""
    if isinstance(kind, type) and issubclass(kind, Message) and (fields := field_types(kind)):
        name, inner = next(iter(fields.items()))
        return f"{{{name}: {_example(inner)}}}"
    zero = zero_of(kind)
    return str(zero).lower() if isinstance(zero, bool) else repr(zero)


def _fill_fields(kind: type[Message], values: object, path: str) -> dict[str, Any]:
    fields = field_types(kind)
    if not isinstance(values, Mapping):
        named = f"; name what is meant, as in {_example(kind)}" if fields else ""
        raise MessageError(f"expected {{{', '.join(fields)}}} at {path}, found {values!r}{named}")
    for name in values:
        if name not in fields:
            near = get_close_matches(str(name), fields, 1)
            hint = f"did you mean {near[0]}?" if near else f"known: {', '.join(fields)}"
            if isinstance(name, int) and values[name] is None:  # what YAML makes of {x: 0,2}
                hint = "a decimal point is a point, no comma"
            raise MessageError(f"{path} has no field {name!r}; {hint}")
    return {
        name: _fill(field, values[name], f"{path}.{name}")
        if name in values
        else msgspec.to_builtins(zero_of(field))
        for name, field in fields.items()
    }
