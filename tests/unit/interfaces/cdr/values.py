"""Messages of any type with any values that have a place in them."""

import random
import struct
from collections.abc import Mapping
from typing import Any

from hypothesis import settings

from zteleop.interfaces import derived, library
from zteleop.interfaces.declared import declared, parts
from zteleop.interfaces.msg_text import PARTS, Type
from zteleop.interfaces.structs import struct_of
from zteleop.messages import MESSAGES, Message

INTEGERS = {
    "byte": (0, 2**7 - 1),  # of these two readers disagree whether they have a sign
    "char": (0, 2**7 - 1),
    **{f"int{bits}": (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for bits in (8, 16, 32, 64)},
    **{f"uint{bits}": (0, 2**bits - 1) for bits in (8, 16, 32, 64)},
}
TIMES = settings.default.max_examples // 10  # type: ignore[attr-defined]
"""messages of each type"""
LETTERS = "abc /\N{LATIN SMALL LETTER E WITH ACUTE}\N{ROBOT FACE}"


def halves() -> list[type[Message]]:
    """Return whatever travels of every service and action that there is."""
    names = [
        f"{package}/{kind}/{leaf}"
        for package in library.packages()
        for kind in ("srv", "action")
        for leaf in library.types(package, kind)
    ]
    own = [name + end for name in names for end in PARTS[name.split("/")[1]]]
    return [
        struct_of(name) for name in own + [one.ros_type for name in names for one in derived.messages(name)]
    ]


def kinds() -> list[type[Message]]:
    """Return every type that there is."""
    theirs = [
        struct_of(f"{package}/msg/{leaf}")
        for package in library.packages()
        for leaf in library.types(package, "msg")
    ]
    return sorted({*MESSAGES.values(), *theirs}, key=lambda kind: kind.ros_type)


def anything(kind: type[Message], dice: random.Random) -> Message:
    """Return a message with random values; arrays are short, and often empty."""
    known = parts(kind)
    return kind(**{field.name: _value(field.type, known, dice) for field in declared(kind).fields})


def _value(kind: Type, known: Mapping[str, type[Message]], dice: random.Random) -> Any:
    if not kind.array:
        return _one(kind, known, dice)
    length = kind.length if kind.array == "fixed" else min(dice.choice([0, 0, 1, 2, 3, 7]), kind.length or 7)
    if kind.name == "uint8":
        return dice.randbytes(length or 0)
    return [_one(kind, known, dice) for _ in range(length or 0)]


def _one(kind: Type, known: Mapping[str, type[Message]], dice: random.Random) -> Any:
    if bounds := INTEGERS.get(kind.name):
        return dice.choice([*bounds, dice.randint(*bounds), 0, 1])
    if kind.name == "bool":
        return dice.random() < 0.5
    if kind.name == "float64":
        return dice.choice([0.0, -1.5, dice.uniform(-1e6, 1e6), 1e308])
    if kind.name == "float32":
        return struct.unpack("<f", struct.pack("<f", dice.uniform(-1e6, 1e6)))[0]
    if kind.name == "string":
        return "".join(dice.choices(LETTERS, k=min(dice.choice([0, 1, 2, 3, 4, 5, 9]), kind.bound or 9)))
    return anything(known[kind.name], dice)
