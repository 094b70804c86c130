"""A message as ROS writes it down: the text of a .msg file, with what is in it below each field."""

from collections.abc import Iterator
from typing import Annotated, Any, ClassVar, Literal, NamedTuple, get_args, get_origin

from msgspec import Meta

from zteleop.interfaces import integers
from zteleop.interfaces.comments import field_comments, type_comment
from zteleop.interfaces.structs import definition_of
from zteleop.messages import MESSAGES, Message
from zteleop.messages.message import field_types

Comments = Literal["first", "all", "none"]
"""of the message itself, also of those in it, or none"""
INDENT = "\t"
_PLAIN = {bool: "bool", int: "int64", float: "float64", str: "string", bytes: "uint8[]", dict: "object"}


class Field(NamedTuple):
    """What ROS calls the type of a field, what ROS has no word for, and the message that is in it."""

    ros_type: str
    note: str = ""
    message: type[Message] | None = None


def definition(kind: type[Message], comments: Comments = "first") -> str:
    """Return the lines of a message, those of a message within it indented."""
    return "\n".join(_lines(kind, comments))


def _lines(kind: type[Message], comments: Comments) -> Iterator[str]:
    said = {} if comments == "none" else field_comments(kind)
    if comments != "none":
        yield from (f"# {line}".rstrip() for line in type_comment(kind).splitlines())
    for name, value in constants_of(kind):
        yield f"{'uint8' if 0 <= value < 256 else 'int32'} {name}={value}"
    inner: Comments = "all" if comments == "all" else "none"
    written = None if kind.ros_type in MESSAGES else definition_of(kind)
    texts = {field.name: field.type.text for field in written.fields} if written else {}
    for name, annotation in field_types(kind).items():
        field = field_of(annotation, kind.ros_type.partition("/")[0])
        note = "; ".join(text for text in (field.note, *said.get(name, "").splitlines()) if text)
        yield f"{texts.get(name, field.ros_type)} {name}{note and f'  # {note}'}"
        if field.message:
            yield from (f"{INDENT}{line}" for line in _lines(field.message, inner))


def field_of(annotation: Any, package: str) -> Field:
    """Return what a field of a message of a package is."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _bounded(arguments[0], _bounds(arguments[1:]), package)
    if origin is Literal:
        plain = _PLAIN.get(type(arguments[0]), "any")
        return Field(plain, f"{' or '.join(str(choice) for choice in arguments)}")
    if type(None) in arguments:
        (given,) = [argument for argument in arguments if argument is not type(None)]
        field = field_of(given, package)
        return field._replace(note="; ".join(text for text in (field.note, "or null") if text))
    if origin is list:
        return _array(arguments[0], "", package)
    if isinstance(annotation, type) and issubclass(annotation, Message):
        own, _, leaf = annotation.ros_type.partition("/")
        leaf = leaf.rpartition("/")[2]
        return Field(leaf if own == package else f"{own}/{leaf}", message=annotation)
    return Field(_PLAIN.get(origin or annotation, "any"))


def _bounded(kind: Any, bounds: dict[str, Any], package: str) -> Field:
    least, most = bounds.get("min_length"), bounds.get("max_length")
    size = str(most) if most is not None and most == least else "" if most is None else f"<={most}"
    if get_origin(kind) is list:
        return _array(get_args(kind)[0], size, package)
    if kind is bytes:
        return Field(f"uint8[{size}]")
    if kind is str and most is not None:
        return Field(f"string<={most}")
    if kind is int and (found := _integer(bounds)):
        return Field(found)
    return field_of(kind, package)._replace(note=_range(bounds, whole=kind is int))


def _integer(bounds: dict[str, Any]) -> str | None:
    """Return the type of ROS that has just these bounds, if there is one."""
    if bounds.keys() == {"ge", "le"} and bounds["le"] == 2**63 - 1:
        return "int64"
    return None if "le" in bounds else integers.NAMES.get((bounds.get("ge"), bounds.get("lt")))


def _array(item: Any, size: str, package: str) -> Field:
    field = field_of(item, package)
    return field._replace(ros_type=f"{field.ros_type}[{size}]")


def _bounds(metas: tuple[Any, ...]) -> dict[str, Any]:
    names = ("ge", "gt", "le", "lt", "min_length", "max_length")
    known = [meta for meta in metas if isinstance(meta, Meta)]
    return {name: getattr(meta, name) for name in names for meta in known if getattr(meta, name) is not None}


def _range(bounds: dict[str, Any], whole: bool) -> str:
    """Return the bounds of a number in words."""
    words = {"ge": "at least", "gt": "more than", "le": "at most", "lt": "less than"}
    if whole and bounds.keys() == {"ge", "lt"}:
        bounds = {"ge": bounds["ge"], "le": bounds["lt"] - 1}
    if "ge" in bounds and "le" in bounds:
        return f"{bounds['ge']} to {bounds['le']}"
    return ", ".join(f"{text} {bounds[name]}" for name, text in words.items() if name in bounds)


def constants_of(kind: type[Message]) -> Iterator[tuple[str, int]]:
    """Yield the names and values of a message's constants, in order."""
    for name, annotation in vars(kind).get("__annotations__", {}).items():
        value = getattr(kind, name, None)
        if annotation == ClassVar[int] and isinstance(value, int):
            yield name, value
