"""Paths to fields, such as `twist.linear.x` and `data[0]`, through the plain values of a message."""

import re
from collections.abc import Iterator
from itertools import islice
from typing import Any

from zteleop.errors import MessageError

Path = tuple[str | int, ...]
_STEP = r"\.*([^.\[\]]+)|\.*\[(-?\d{1,9})\]"
_LONGEST = 1000
_MOST, _FEW = 500, 20
"""names of a message in which somebody's is sought, and which are told"""


def parse(text: str) -> Path:
    """Return the steps that a path takes; raises MessageError when it is none."""
    if len(text) > _LONGEST:
        raise MessageError(f"a field has at most {_LONGEST} characters, found {len(text)}")
    steps, pattern = list[str | int](), re.compile(_STEP)
    at, end = 0, len(text.rstrip("."))
    while at < end:
        step = pattern.match(text, at)
        if not step:
            break
        steps.append(int(step[2]) if step[1] is None else step[1])
        at = step.end()
    if at < end or not steps:
        raise MessageError(f"Invalid field value {text!r}; a field is such as twist.linear.x or data[0]")
    return tuple(steps)


def named(path: Path) -> str:
    """Return a path as it is written."""
    text = "".join(f"[{step}]" if isinstance(step, int) else f".{step}" for step in path)
    return text.removeprefix(".")


def step_into(value: Any, step: str | int, where: str) -> Any:
    """Return the field or the item of a value; raises MessageError, naming `where` the value is."""
    if isinstance(step, str):
        if isinstance(value, dict) and step in value:
            return value[step]
        raise MessageError(f"{where} has no field {step!r}")
    if isinstance(value, list | bytes) and -len(value) <= step < len(value):
        return value[step]
    size = f"has {len(value)} items" if isinstance(value, list | bytes) else "is no list"
    raise MessageError(f"{where} {size}; there is no [{step}]")


def value_at(values: Any, path: Path, title: str = "the message") -> Any:
    """Return what is found on a path; raises MessageError with the nearest paths there are."""
    found = values
    for done in range(len(path)):
        found = _follow(values, found, path, done, title)
    return found


def check(example: Any, path: Path, title: str) -> None:
    """Raise MessageError when a message like the example has no such path.

    What an empty list or a null of the example would hold is not known, and passes.
    """
    found = example
    for done in range(len(path)):
        if found is None or found in ([], b""):
            return
        found = _follow(example, found, path, done, title)


def _follow(values: Any, found: Any, path: Path, done: int, title: str) -> Any:
    try:
        return step_into(found, path[done], f"{title}.{named(path[:done])}" if done else title)
    except MessageError as error:
        hint = f"; {_hint(values, found, path, done)}" if isinstance(path[done], str) else ""
        raise MessageError(f"Invalid field '{named(path)}': {error}{hint}") from None


def _hint(values: Any, found: Any, path: Path, done: int) -> str:
    """Say which path may have been meant: the nearest in the whole message, else the fields here."""
    from difflib import get_close_matches

    if not isinstance(found, dict):
        return "of a list say which item: [0]" if isinstance(found, list | bytes) else "it has no fields"
    wanted, known = named(path), list(islice(_names(values), _MOST))
    ends = [name for name in known if name.endswith(f".{wanted}")]
    near = ends or get_close_matches(wanted, known, 1)
    return f"did you mean {near[0]}?" if near else f"known: {', '.join(list(found)[:_FEW]) or 'none'}"


def _names(value: Any, done: Path = ()) -> Iterator[str]:
    """Yield every path of a message, of a list only its first item's."""
    items: Any = value.items() if isinstance(value, dict) else ()
    items = enumerate(value[:1]) if isinstance(value, list) else items
    for step, item in items:
        yield named((*done, step))
        yield from _names(item, (*done, step))


def leaves(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the path and the value of whatever has nothing within it, in order."""
    if isinstance(value, dict) and value:
        for key, item in value.items():
            yield from leaves(item, f"{name}.{key}" if name else str(key))
    elif isinstance(value, list) and value:
        for index, item in enumerate(value):
            yield from leaves(item, f"{name}[{index}]")
    else:
        yield name, value
