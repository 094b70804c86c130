"""Values of parameters as a person writes them: alone, or in a file of ROS's form.

    /abe/keyboard:
      ros__parameters:
        log_level: info
        speeds:
          forward: 0.5

A node's name may have wildcards: `*` is one part of it, `**` any.
"""

from collections.abc import Iterator, Mapping
from typing import Any

from zteleop.errors import MessageError
from zteleop.interfaces.parameters import from_python
from zteleop.messages import Parameter, ParameterValue
from zteleop.text import yaml_text
from zteleop.text.rendering import to_yaml

KEY = "ros__parameters"
_DEEPEST = 20


def typed(text: str, kind: int) -> ParameterValue:
    """Return the value that a text is, for a parameter of a type.

    Raises MessageError when it is no YAML, or nothing that a parameter can be.
    """
    value = yaml_text.load(text)
    if kind == ParameterValue.STRING and not isinstance(value, str):
        value = text
    return from_python(value)


def dump(node: str, values: Mapping[str, Any]) -> str:
    """Return the file that sets a node's parameters so: names with dots are nested."""
    nested: dict[str, Any] = {}
    for name, value in sorted(values.items()):
        _insert(nested, name, value)
    return to_yaml({node: {KEY: nested}})


def load(text: str, node: str, *, wildcards: bool = True) -> list[Parameter]:
    """Return what a file says of a node, called `/abe/keyboard`; what stands below wins.

    Raises MessageError when it is no such file, or a value is none of a parameter.
    """
    values: dict[str, Any] = {}
    for name, parameters in _nodes(yaml_text.load(text), (), 0):
        if _matches(name, tuple(node.split("/")[1:])) and (wildcards or "*" not in "".join(name)):
            values |= _flat(parameters, "", 0)
    return [Parameter(name, _value(name, value)) for name, value in values.items()]


def nodes(text: str) -> list[str]:
    """Return the names, or patterns of names, for which a file has parameters."""
    return ["/" + "/".join(name) for name, _ in _nodes(yaml_text.load(text), (), 0)]


def _insert(nested: dict[str, Any], name: str, value: Any) -> None:
    """Put a value in its place; where a value stands in the way, under its whole name."""
    head, _, rest = name.partition(".")
    below = nested.setdefault(head, {}) if rest else None
    if isinstance(below, dict):
        _insert(below, rest, value)
    else:
        nested[name] = value


def _nodes(values: Any, above: tuple[str, ...], depth: int) -> Iterator[tuple[tuple[str, ...], Any]]:
    if not isinstance(values, Mapping) or depth > _DEEPEST:
        where = f"at /{'/'.join(above)}" if above else "at the top"
        raise MessageError(f"expected nodes, each with {KEY}, {where}; found {_short(values)}")
    for name, value in values.items():
        if name == KEY:
            yield above, value
        else:
            yield from _nodes(value, (*above, *filter(None, str(name).split("/"))), depth + 1)


def _matches(pattern: tuple[str, ...], name: tuple[str, ...]) -> bool:
    if not pattern or not name:
        return pattern == name or set(pattern) == {"**"}
    if pattern[0] == "**":
        return _matches(pattern[1:], name) or _matches(pattern, name[1:])
    return pattern[0] in ("*", name[0]) and _matches(pattern[1:], name[1:])


def _flat(values: Any, prefix: str, depth: int) -> dict[str, Any]:
    if not isinstance(values, Mapping) or depth > _DEEPEST:
        raise MessageError(f"expected names and values under {prefix or KEY}, found {_short(values)}")
    found: dict[str, Any] = {}
    for name, value in values.items():
        below = isinstance(value, Mapping)
        found |= _flat(value, f"{prefix}{name}.", depth + 1) if below else {f"{prefix}{name}": value}
    return found


def _value(name: str, value: Any) -> ParameterValue:
    try:
        return from_python(value)
    except MessageError as error:
        raise MessageError(f"{name}: {error}") from None


def _short(value: Any) -> str:
    return "nothing" if value is None else f"{value!r:.60}"
