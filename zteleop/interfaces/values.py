"""From values that a person wrote to a message."""

from collections.abc import Mapping
from difflib import get_close_matches
from typing import Any, TypeVar

import msgspec

from zteleop.errors import MessageError
from zteleop.messages import Message

M = TypeVar("M", bound=Message)


def fill(kind: type[M], values: object) -> M:
    """Return a message with these fields, and zeros for the others, as `ros2 topic pub` does.

    Raises MessageError with the path of what does not fit, and the nearest names.
    """
    filled = _merge(msgspec.to_builtins(kind.zero()), {} if values is None else values, kind.__name__)
    try:
        return msgspec.convert(filled, kind)
    except msgspec.ValidationError as error:
        raise MessageError(f"not a {kind.__name__}: {error}") from None


def _merge(zero: Any, values: object, path: str) -> Any:
    if not isinstance(zero, dict):
        return values
    if not isinstance(values, Mapping):
        raise MessageError(f"expected {{{', '.join(zero)}}} at {path}, found {values!r}")
    for name in values:
        if name not in zero:
            near = get_close_matches(str(name), zero, 1)
            hint = f"did you mean {near[0]}?" if near else f"known: {', '.join(zero)}"
            raise MessageError(f"{path} has no field {name!r}; {hint}")
    return {name: _merge(old, values.get(name, old), f"{path}.{name}") for name, old in zero.items()}
