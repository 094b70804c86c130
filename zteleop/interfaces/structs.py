"""Structs made from ROS's interface text; where zteleop.messages has the type, that one is it."""

from collections.abc import Callable, Mapping
from keyword import iskeyword
from typing import Annotated, Any, ClassVar
from weakref import WeakKeyDictionary

import msgspec
from msgspec import Meta

from zteleop.errors import MessageError
from zteleop.interfaces.library import definition, has
from zteleop.interfaces.msg_text import Definition, Type
from zteleop.messages import MESSAGES, Message
from zteleop.messages.std import Int8, Int16, Int32, Int64, UInt8, UInt16, UInt32, UInt64

DEEPEST = 50
"""messages within messages"""
PLAIN: dict[str, Any] = {
    "bool": bool,
    "byte": UInt8,
    "char": UInt8,
    "float32": float,
    "float64": float,
    "int8": Int8,
    "int16": Int16,
    "int32": Int32,
    "int64": Int64,
    "uint8": UInt8,
    "uint16": UInt16,
    "uint32": UInt32,
    "uint64": UInt64,
    "string": str,
    "wstring": str,
}
"""by ROS's name: the annotation of one; an array of uint8 is bytes"""
Find = Callable[[str], Definition]
_made: dict[str, type[Message]] = {}
_definitions: WeakKeyDictionary[type[Message], Definition] = WeakKeyDictionary()


def struct_of(ros_type: str) -> type[Message]:
    """Return the Struct of a message, or of a part of a service or an action; always the same one.

    Raises MessageError when there is no such type, or none can be made of it.
    """
    return _Structs(definition, MESSAGES, _made).of(ros_type)


def struct_from(ros_type: str, find: Find, known: Mapping[str, type[Message]]) -> type[Message]:
    """Return a Struct of what `find` says of each type, but the `known` one where there is one.

    Raises MessageError as struct_of does.
    """
    return _Structs(find, known, {}).of(ros_type)


def definition_of(kind: type[Message]) -> Definition | None:
    """Return the text that a Struct was made from, or stands for; None where there is none."""
    if MESSAGES.get(kind.ros_type) is kind:
        return definition(kind.ros_type) if has(kind.ros_type) else None
    return _definitions.get(kind)


def annotations_of(found: Definition) -> dict[str, Any]:
    """Return the annotation of each field, as zteleop.messages has them."""
    structs = _Structs(definition, MESSAGES, _made)
    return {field.name: structs.annotation(field.type, (found.ros_type,)) for field in found.fields}


class _Structs:
    def __init__(
        self, find: Find, known: Mapping[str, type[Message]], made: dict[str, type[Message]]
    ) -> None:
        self._find = find
        self._known = known
        self._made = made

    def of(self, ros_type: str, within: tuple[str, ...] = ()) -> type[Message]:
        if found := self._known.get(ros_type) or self._made.get(ros_type):
            return found
        if ros_type in within or len(within) > DEEPEST:
            way = " in ".join(reversed((*within[-4:], ros_type)))
            raise MessageError(f"a message within itself, or {DEEPEST} deep in others, is none: {way}")
        # a second thread may have made it meanwhile: the first to come is the type
        return self._made.setdefault(ros_type, self._build(self._find(ros_type), (*within, ros_type)))

    def annotation(self, kind: Type, within: tuple[str, ...]) -> Any:
        if kind.name == "uint8" and kind.array:
            return _sized(bytes, kind)
        item: Any = PLAIN.get(kind.name) or self.of(kind.name, within)
        if kind.bound:
            item = Annotated[item, Meta(max_length=kind.bound)]
        return _sized(list[item], kind) if kind.array else item

    def _build(self, found: Definition, within: tuple[str, ...]) -> type[Message]:
        _check_names(found)
        fields = [(field.name, self.annotation(field.type, within)) for field in found.fields]
        values = {constant.name: constant.value for constant in found.constants}
        built: Any = msgspec.defstruct(
            found.ros_type.rpartition("/")[2],
            fields,
            bases=(Message,),
            namespace={"ros_type": found.ros_type, **values},
            module=__name__,
        )
        built.__annotations__.update({name: ClassVar[type(value)] for name, value in values.items()})
        _definitions[built] = found
        return built  # type: ignore[no-any-return]


def _check_names(found: Definition) -> None:
    taken = {"ros_type", *dir(Message)}
    for name in [part.name for part in found.fields] + [part.name for part in found.constants]:
        if iskeyword(name) or name in taken:
            raise MessageError(f"{name!r} in {found.ros_type} cannot be a name in Python; call it {name}_")


def _sized(array: Any, kind: Type) -> Any:
    if not kind.length:
        return array
    least = kind.length if kind.array == "fixed" else None
    return Annotated[array, Meta(min_length=least, max_length=kind.length)]
