"""Makes, for a type of message, the function that reads one: nothing is made that is longer than the data."""

import struct
from collections.abc import Callable
from functools import cache, partial
from typing import Any

from zteleop.errors import MessageError
from zteleop.interfaces.cdr import refusal
from zteleop.interfaces.cdr.runs import CODES, WORD, Part, run, runs
from zteleop.interfaces.cdr.source import Source
from zteleop.interfaces.declared import declared, parts
from zteleop.interfaces.msg_text import Type
from zteleop.messages import Message

Read = Callable[[bytes, int], tuple[Any, int]]
"""from the whole data, and a place in it, to what begins there and where it ends"""
HEADER, PADDING = 4, 3
"""bytes before a message, and those that may follow so that its length is one of 4"""
_HEAD = Part("H", 1)


@cache
def decoder(kind: type[Message]) -> Callable[[bytes], Message]:
    """Return what decodes messages of a type; raises MessageError where CDR, or ROS, has no word for it."""
    return _decoder(kind, "<")


@cache
def _decoder(kind: type[Message], order: str) -> Callable[[bytes], Message]:
    return _Reader(kind, order, "def decode(data):").whole()


@cache
def reader(kind: type[Message], order: str) -> Read:
    """Return what reads messages of a type within others, in the order "<" or ">" of bytes."""
    return _Reader(kind, order, "def read(data, at):").part()


class _Reader:
    def __init__(self, kind: type[Message], order: str, first: str) -> None:
        self._kind = kind
        self._parts = parts(kind)
        self._order = order
        self._source = Source(first)
        self._run: list[Part] = []
        self._names: list[str] = []
        self._place: int | None = None
        """in the whole data; None where that depends on the message: it is `at`"""

    def whole(self) -> Callable[[bytes], Message]:
        self._source.line("try:")
        self._source.indent(1)
        self._place = 0
        value = self._message(self._kind)
        self._flush()
        if self._place == 0:
            self._begin()
        long = self._source.hold("long", partial(refusal.long, self._kind.ros_type))
        self._source.line(f"if len(data) - {self._at()} > {PADDING}: {long}({self._at()}, len(data))")
        self._source.line(f"return {value}")
        self._source.indent(-1)
        fail = self._source.hold("fail", partial(refusal.broken, self._kind.ros_type))
        self._source.line(f"except {self._source.hold('wrong', refusal.WRONG)} as error:")
        self._source.line(f"    {fail}(data, error)")
        return self._source.function("decode", f"<reads {self._kind.ros_type}>")  # type: ignore[no-any-return]

    def part(self) -> Read:
        value = self._message(self._kind)
        self._flush()
        self._source.line(f"return {value}, at")
        return self._source.function("read", f"<reads {self._kind.ros_type}>")  # type: ignore[no-any-return]

    def _message(self, kind: type[Message]) -> str:
        """Return the expression of a message whose parts are read before it is needed."""
        fields = declared(kind).fields
        if not fields:
            self._add("B")  # what has no member has this one
        values = [self._field(field.type) for field in fields]
        return f"{self._source.hold('Made', kind)}({', '.join(values)})"

    def _field(self, kind: Type) -> str:
        if kind.array == "fixed":
            return self._fixed(kind)
        if kind.array:
            return self._sequence(kind)
        if kind.name in CODES:
            return self._add(CODES[kind.name])
        if kind.name == "string":
            return self._text(kind)
        return self._message(self._inner(kind))

    def _inner(self, kind: Type) -> type[Message]:
        if kind.name not in self._parts:
            raise MessageError(f"{self._kind.ros_type} holds a {kind.name}, which CDR tells in several ways")
        return self._parts[kind.name]

    def _text(self, kind: Type) -> str:
        length, name = self._add("I"), self._source.name("text")
        self._flush()
        at = self._at()
        self._source.line(f"{name} = data[{at} : {at} + {length} - 1].decode()")
        self._source.line(f"at = {at} + {length}")
        # its end; of one of no bytes, the last of a length of zero
        self._source.line(f"if data[at - 1]: {self._source.hold('endless', refusal.endless)}()")
        self._place = None
        if kind.bound:
            self._check_most(f"len({name})", kind.bound)
        return name

    def _sequence(self, kind: Type) -> str:
        length, name = self._add("I"), self._source.name("items")
        self._flush()
        self._settle()
        if kind.length:
            self._check_most(length, kind.length)
        if kind.name == "uint8":
            self._check(f"at + {length}")
            self._source.line(f"{name} = data[at : at + {length}]")
            self._source.line(f"at += {length}")
        elif code := CODES.get(kind.name):
            self._items(code, length, name)
        else:
            self._each(kind, length, name)
        return name

    def _items(self, code: str, length: str, name: str) -> None:
        unpack, size = self._source.hold("unpack", struct.unpack_from), struct.calcsize(f"<{code}")
        self._source.line(f"{name} = []")
        self._source.line(f"if {length}:")
        self._source.indent(1)
        self._align(size)
        self._check(f"at + {length} * {size}")
        self._source.line(f"{name} = list({unpack}(f'{self._order}{{{length}}}{code}', data, at))")
        self._source.line(f"at += {length} * {size}")
        self._source.indent(-1)

    def _fixed(self, kind: Type) -> str:
        if kind.name == "uint8":
            return self._add("s", kind.length or 0)
        if code := CODES.get(kind.name):
            return f"list({self._add(code, kind.length or 0, many=True)})"
        name = self._source.name("items")
        self._flush()
        if self._place == 0:
            self._begin()
        self._settle()
        self._each(kind, str(kind.length), name)
        return name

    def _each(self, kind: Type, length: str, name: str) -> None:
        text = kind.name == "string"
        read: Any = _text_reader(self._order, kind.bound) if text else reader(self._inner(kind), self._order)
        held, item = self._source.hold("read", read), self._source.name("item")
        self._check(f"at + {length}")  # each is a byte at least
        self._source.line(f"{name} = []")
        self._source.line(f"for _ in range({length}):")
        self._source.line(f"    {item}, at = {held}(data, at)")
        self._source.line(f"    {name}.append({item})")

    def _check(self, end: str) -> None:
        self._source.line(
            f"if {end} > len(data): {self._source.hold('short', refusal.short)}({end}, len(data))"
        )

    def _check_most(self, found: str, most: int) -> None:
        self._source.line(
            f"if {found} > {most}: {self._source.hold('too_many', refusal.too_many)}({most}, {found})"
        )

    def _add(self, code: str, count: int = 1, many: bool = False) -> str:
        self._run.append(Part(code, count))
        self._names.append(self._source.name("many" if many else "value"))
        return self._names[-1]

    def _flush(self) -> None:
        """Read the run of values that has come together."""
        if not self._run:
            return
        if self._place == 0:
            self._begin()
        elif self._place is not None:
            found = run(self._run, (self._place - HEADER) % WORD, self._order).packed
            self._unpack(self._source.hold("unpack", found.unpack_from), str(self._place), self._names)
            self._place += found.size
        elif self._run[0].size == max(part.size for part in self._run):
            self._align(self._run[0].size)
            found = run(self._run, 0, self._order).packed
            self._unpack(self._source.hold("unpack", found.unpack_from), "at", self._names)
            self._source.line(f"at += {found.size}")
        else:
            formats = [(one.packed.unpack_from, one.packed.size) for one in runs(self._run, self._order)]
            turned = formats[HEADER:] + formats[:HEADER]  # by the place in the whole data
            self._source.line(f"unpack, size = {self._source.hold('unpacks', turned)}[at % {WORD}]")
            self._unpack("unpack", "at", self._names)
            self._source.line("at += size")
        self._run, self._names = [], []

    def _begin(self) -> None:
        """Read the header together with the first run."""
        found = run(self._run, 0, self._order, before="H2x").packed
        self._run.insert(0, _HEAD)
        self._unpack(self._source.hold("unpack", found.unpack_from), "0", ["head", *self._names])
        head = int.from_bytes(refusal.ORDERS[self._order], "little" if self._order == "<" else "big")
        other = self._source.hold("other", partial(_other, self._kind))
        self._source.line(f"if head != {head}: return {other}(data)")
        self._place, self._run, self._names = found.size, [], []

    def _unpack(self, unpack: str, place: str, names: list[str]) -> None:
        if not any(name.startswith("many") for name in names):
            self._source.line(f"{', '.join(names)}, = {unpack}(data, {place})")
            return
        self._source.line(f"values = {unpack}(data, {place})")
        begin = 0
        for part, name in zip(self._run, names, strict=True):
            many = name.startswith("many")
            end = begin + (part.number if many else 1)
            self._source.line(f"{name} = values[{f'{begin}:{end}' if many else begin}]")
            begin = end

    def _align(self, size: int) -> None:
        if size == WORD:
            self._source.line(f"at += {HEADER} - at & {WORD - 1}")
        elif size > 1:
            self._source.line(f"at += -at & {size - 1}")

    def _at(self) -> str:
        return "at" if self._place is None else str(self._place)

    def _settle(self) -> None:
        if self._place is not None:
            self._source.line(f"at = {self._place}")
        self._place = None


@cache
def _text_reader(order: str, bound: int | None) -> Read:
    length_at = struct.Struct(f"{order}I").unpack_from

    def read(data: bytes, at: int) -> tuple[str, int]:
        at += -at & 3
        (length,) = length_at(data, at)
        at += 4
        text = data[at : at + length - 1].decode()
        at += length
        if data[at - 1]:
            refusal.endless()
        if bound and len(text) > bound:
            refusal.too_many(bound, len(text))
        return text, at

    return read


def _other(kind: type[Message], data: bytes) -> Message:
    """Read what does not begin as it does in the order that is tried first."""
    if data[:2] != refusal.ORDERS[">"]:
        raise MessageError(refusal.header(data))
    return _decoder(kind, ">")(data)
