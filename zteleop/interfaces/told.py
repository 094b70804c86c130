"""Structs of types of which a stranger tells what they are made of: bounded, and our own where they agree."""

from collections.abc import Callable, Mapping

from zteleop.errors import MessageError
from zteleop.interfaces import library
from zteleop.interfaces.declared import declared, parts
from zteleop.interfaces.msg_text import Definition, Type
from zteleop.interfaces.structs import struct_from
from zteleop.messages import MESSAGES, Message

MOST_VALUES, LARGEST = 5000, 2**22
"""values that a message may have side by side, and with all those in arrays of a fixed length"""


def struct_told(ros_type: str, found: Mapping[str, Definition]) -> type[Message]:
    """Return the Struct of a type, made of what is told of it and of those in it.

    What is left out is as it is in the library. Raises MessageError where it is no message, or too large.
    """

    def definition(name: str) -> Definition:
        if name in found:
            return found[name]
        if library.has(name):  # some leave out what everybody knows
            return library.definition(name)
        raise MessageError(f"the schema of {ros_type} does not say what {name} is")

    known = {
        name: kind
        for name, kind in MESSAGES.items()
        if name not in found or _same(found[name], declared(kind))
    }
    kind = struct_from(ros_type, definition, _whole(known, found))
    _check_size(kind)
    return kind


def _same(theirs: Definition, ours: Definition) -> bool:
    return [(f.type, f.name) for f in theirs.fields] == [(f.type, f.name) for f in ours.fields]


def _whole(known: Mapping[str, type[Message]], found: Mapping[str, Definition]) -> dict[str, type[Message]]:
    """Return the types of which also every part is the one we know."""
    return {
        name: kind for name, kind in known.items() if all(p in known or p not in found for p in parts(kind))
    }


def _check_size(kind: type[Message]) -> None:
    """Raise MessageError for a few lines that stand for millions of values, each type twice in the next."""
    known, sizes = parts(kind), dict[str, tuple[int, int]]()

    def sizes_of(part: type[Message]) -> tuple[int, int]:
        if part.ros_type not in sizes:
            each = [_sizes(field.type, sizes_of, known) for field in declared(part).fields]
            beside, whole = sizes[part.ros_type] = sum(one for one, _ in each), sum(all_ for _, all_ in each)
            if beside > MOST_VALUES or whole > LARGEST:
                raise MessageError(f"{part.ros_type} has more values than are read: {max(beside, whole)}")
        return sizes[part.ros_type]

    sizes_of(kind)


def _sizes(
    kind: Type, of: Callable[[type[Message]], tuple[int, int]], known: Mapping[str, type[Message]]
) -> tuple[int, int]:
    """Return how many values a field has side by side, and how many with a fixed array's items."""
    beside, whole = of(known[kind.name]) if kind.name in known else (1, 1)
    length = (kind.length or 0) if kind.array == "fixed" else 1
    return 1 if kind.array else beside, 1 if kind.array in ("bounded", "unbounded") else whole * length
