"""Types as another distribution of ROS 2 has them, where they are not what they are in Jazzy.

Between Humble and Lyrical few differ in what travels: the texts of those stand in definitions_of/.
"""

from functools import cache, lru_cache
from pathlib import Path
from typing import Any

from zteleop.errors import MessageError
from zteleop.interfaces.declared import message_in, parts
from zteleop.interfaces.library import definition
from zteleop.interfaces.msg_text import Definition, parse_message
from zteleop.interfaces.structs import struct_from, struct_of
from zteleop.messages import MESSAGES, Message
from zteleop.messages.message import field_types, zero_of

CHANGED = {
    "humble": "humble",
    "iron": "",
    "jazzy": "",
    "kilted": "",
    "lyrical": "lyrical",
    "rolling": "lyrical",
}
"""by distribution: whose texts stand before those of the library"""
_FOLDER = Path(__file__).with_name("definitions_of")
_MOST = 1024
"""types that are remembered"""


@lru_cache(_MOST)
def struct_for(ros_type: str, distro: str) -> type[Message]:
    """Return the Struct of a type as a distribution has it; struct_of's own where there is no difference.

    Raises MessageError when there is no such type or distribution.
    """
    theirs, ours = changed(distro), struct_of(ros_type)
    if theirs.keys().isdisjoint(parts(ours)):
        return ours
    known = {name: kind for name, kind in MESSAGES.items() if theirs.keys().isdisjoint(parts(kind))}
    return struct_from(ros_type, lambda name: theirs.get(name) or definition(name), known)


@cache
def changed(distro: str) -> dict[str, Definition]:
    """Return the types that a distribution has otherwise than Jazzy."""
    if distro not in CHANGED:
        raise MessageError(f"expected a distribution such as {', '.join(CHANGED)}, found {distro!r:.80}")
    if not CHANGED[distro]:
        return {}
    files = sorted((_FOLDER / CHANGED[distro]).rglob("*.msg"))
    named = {f"{path.parents[1].name}/msg/{path.stem}": path for path in files}
    return {name: parse_message(path.read_text(encoding="utf-8"), name) for name, path in named.items()}


def adapted(message: Message, kind: type[Message]) -> Message:
    """Return a message as another version of its type: what one has not is left out, or zero."""
    if type(message) is kind:
        return message
    return kind(
        **{
            name: _fit(getattr(message, name), annotation, kind)
            if hasattr(message, name)
            else zero_of(annotation)
            for name, annotation in field_types(kind).items()
        }
    )


def _fit(value: Any, annotation: Any, of: type[Message]) -> Any:
    inner = message_in(annotation, of.ros_type.partition("/")[0])
    if not inner:
        return value
    return [adapted(item, inner) for item in value] if isinstance(value, list) else adapted(value, inner)
