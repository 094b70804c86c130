"""Values as a person writes them: YAML, which JSON is a part of."""

import re
from collections.abc import Iterable
from functools import cache
from typing import Any

from zteleop.errors import MessageError

EXAMPLE = "{linear: {x: 0.2}}"
LONGEST = 1 << 20
"""characters of one text, and values that it may stand for"""
DEEPEST = 100
"""values within values; to build deeper ones ends the process"""
_SHOWN, _MOST_DIGITS = 80, 400
_FLOAT = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+")


def load(text: str) -> Any:
    """Return the values a text stands for; raises MessageError with the place of a mistake."""
    if len(text) > LONGEST:
        raise MessageError(f"expected at most {LONGEST} characters of YAML, found more")
    import yaml

    try:
        if sum(map(text.count, "[{-?:*")) > DEEPEST or "*" in text:
            _bound(yaml.parse(text, Loader=_loader()))
        return yaml.load(text, Loader=_loader())
    except MessageError as error:
        raise _refusal(text, str(error)) from None
    except yaml.MarkedYAMLError as error:
        raise _refusal(text, _place(text, error)) from None
    except Exception as error:  # a tag such as !!timestamp on another text fails in ways of its own
        raise _refusal(text, " ".join(str(error).split())) from None


def _bound(events: Iterable[Any]) -> None:
    """Raise MessageError when values are nested too deeply, or repeat one another too often."""
    named: dict[str, int] = {}
    sizes: list[tuple[int, str | None]] = [(0, None)]
    """of what is open: the values in it so far, and its name"""
    for event in events:
        kind, anchor = type(event).__name__, getattr(event, "anchor", None)
        if kind.endswith(("SequenceStartEvent", "MappingStartEvent")):
            sizes.append((1, anchor))
        elif kind in ("SequenceEndEvent", "MappingEndEvent"):
            size, anchor = sizes.pop()
            _add(sizes, named, size, anchor)
        elif kind == "ScalarEvent":
            _add(sizes, named, 1, anchor)
        elif kind == "AliasEvent":
            if any(anchor == name for _, name in sizes):
                raise MessageError(f"*{anchor} stands within itself")
            _add(sizes, named, named.get(anchor or "", 1), None)
        if len(sizes) > DEEPEST or sizes[-1][0] > LONGEST:
            raise MessageError(f"it is nested more than {DEEPEST} deep, or stands for too many values")


def _add(sizes: list[tuple[int, str | None]], named: dict[str, int], size: int, anchor: str | None) -> None:
    if anchor:
        named[anchor] = size
    sizes[-1] = (sizes[-1][0] + size, sizes[-1][1])


def _refusal(text: str, problem: str) -> MessageError:
    shown = text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."
    return MessageError(f"expected YAML such as '{EXAMPLE}', found {shown!r}: {problem}")


def _place(text: str, error: Any) -> str:
    mark = error.problem_mark or error.context_mark
    problem = " ".join(str(error.problem or error.context).split())
    if mark is None:
        return problem
    ended = mark.line >= len(text.rstrip().splitlines())
    return f"{'at its end' if ended else f'line {mark.line + 1}, column {mark.column + 1}'}: {problem}"


def _integer(loader: Any, node: Any) -> int:
    """Return a whole number; one of more digits takes long, and cannot even be shown."""
    if len(str(node.value)) > _MOST_DIGITS:
        raise MessageError(f"a number has at most {_MOST_DIGITS} digits")
    return int(loader.construct_yaml_int(node))


@cache
def _loader() -> Any:
    """Return a safe loader to which 1e-3 is a number, as to everybody but YAML 1.1."""
    import yaml

    loader = type("Loader", (getattr(yaml, "CSafeLoader", yaml.SafeLoader),), {})
    loader.add_constructor("tag:yaml.org,2002:int", _integer)  # type: ignore[attr-defined]
    loader.add_implicit_resolver("tag:yaml.org,2002:float", _FLOAT_LINE, list("-+.0123456789"))  # type: ignore[attr-defined]
    return loader


_FLOAT_LINE = re.compile(rf"(?:{_FLOAT.pattern})$")
