"""Messages as `ros2 topic echo` prints them: YAML, or a row of CSV; long ones are cut short."""

from collections.abc import Iterable
from functools import cache
from io import StringIO
from itertools import islice
from typing import Annotated, Any, NamedTuple, get_args, get_origin

from msgspec import Meta

from zteleop.interfaces import integers
from zteleop.messages import Message
from zteleop.messages.message import field_types

CUT = 128
"""items of an array and characters of a text, after which `...` stands for the rest"""
_WIDEST = 2**31 - 1
_PLAIN = {bool: "boolean", int: "int64", float: "double", str: "string"}


class Style(NamedTuple):
    """How much of a message is shown."""

    longest: int | None = CUT
    no_arrays: bool = False
    no_strings: bool = False
    flow: bool = False


def shorten(value: Any, style: Style, kind: Any = None) -> Any:
    """Return plain values as they are shown; of a `kind`, where it is known, which names their types."""
    if isinstance(value, dict):
        fields = field_types(kind) if _is_message(kind) else {}
        return {key: shorten(item, style, fields.get(key)) for key, item in value.items()}
    if isinstance(value, list | bytes):
        return _array(value, style, kind)
    return _text(value, style) if isinstance(value, str) else value


def _text(value: str, style: Style) -> str:
    if style.no_strings:
        return f"<string length: <{len(value)}>>"
    cut = style.longest is not None and len(value) > style.longest
    return f"{value[: style.longest]}..." if cut else value


def _array(value: list[Any] | bytes, style: Style, kind: Any) -> Any:
    if style.no_arrays:
        return _array_type(value, kind)
    item = _item_of(kind)
    shown = [shorten(each, style, item) for each in islice(value, style.longest)]
    return [*shown, "..."] if len(shown) < len(value) else shown


def _array_type(value: list[Any] | bytes, kind: Any) -> str:
    item = _item_of(kind)
    name = _type_name(item) if item is not None else _plain_name(value)
    least, most = _bound(kind, "min_length"), _bound(kind, "max_length")
    if least is not None and least == most:
        return f"<array type: {name}[{most}]>"
    bound = "" if most is None else f"[{most}]"
    return f"<sequence type: {name}{bound}, length: {len(value)}>"


def _plain_name(value: list[Any] | bytes) -> str:
    """Return what ROS calls the items of an array of which no type is known."""
    return "uint8" if isinstance(value, bytes) else _PLAIN.get(type(next(iter(value), None)), "unknown")


def _type_name(kind: Any) -> str:
    """Return what ROS calls the type of a field."""
    if _is_message(kind):
        return str(kind.ros_type)
    inner = _inner(kind)
    if inner is int and (least := _bound(kind, "ge")) is not None:
        return integers.NAMES.get((least, _bound(kind, "lt")), "int64")
    return _PLAIN.get(inner, "unknown")


def _item_of(kind: Any) -> Any:
    inner = _inner(kind)
    return get_args(inner)[0] if get_origin(inner) is list else None


def _inner(kind: Any) -> Any:
    return get_args(kind)[0] if get_origin(kind) is Annotated else kind


def _bound(kind: Any, name: str) -> Any:
    metas = get_args(kind)[1:] if get_origin(kind) is Annotated else ()
    return next(
        (getattr(m, name) for m in metas if isinstance(m, Meta) and getattr(m, name) is not None), None
    )


def _is_message(kind: Any) -> bool:
    return isinstance(kind, type) and issubclass(kind, Message)


def to_yaml(values: Any, flow: bool = False) -> str:
    """Return values as one YAML document, each line of it ended; a plain value is its text alone."""
    if not isinstance(values, dict | list):
        return f"{values}\n"
    import yaml

    return str(
        yaml.dump(
            values,
            Dumper=dumper(),
            sort_keys=False,
            allow_unicode=True,
            default_flow_style=flow,
            width=_WIDEST,
        )
    )


@cache
def dumper() -> Any:
    """Return a dumper that writes what is there twice twice, without the names that YAML has for that."""
    import yaml

    fast = getattr(yaml, "CSafeDumper", yaml.SafeDumper)
    return type("Dumper", (fast,), {"ignore_aliases": lambda self, data: True})


def csv_line(cells: Iterable[Any]) -> str:
    """Return cells as one line of CSV, not ended; what is empty is an empty cell."""
    import csv

    text = StringIO()
    csv.writer(text, lineterminator="").writerow(map(_cell, cells))
    return text.getvalue()


def _cell(value: Any) -> Any:
    if isinstance(value, str):
        return value.replace("\n", "\\u000a")
    return "" if value in ([], {}) else value
