"""Makes, for a type of message, the function that writes one: in pieces, which are joined at the end."""

import struct
from collections.abc import Callable
from functools import cache
from typing import Any

from zteleop.errors import MessageError
from zteleop.interfaces.cdr.runs import CODES, WORD, Part, end_of, run, runs
from zteleop.interfaces.cdr.source import Source
from zteleop.interfaces.declared import declared, parts
from zteleop.interfaces.msg_text import Type
from zteleop.messages import Message

HEADER = b"\0\1\0\0"
Write = Callable[[Any, list[bytes], int], int]
"""adds the pieces of what begins so many bytes after the header, and returns where it ends"""
_LENGTH = struct.Struct("<I").pack
_UNFIT = (struct.error, TypeError, AttributeError, UnicodeError, OverflowError)
_END = Part("x", 1)
"""of a text"""
_MOST_TERMS = 4
"""lengths that are added up at a time"""


@cache
def encoder(kind: type[Message]) -> Callable[[Message], bytes]:
    """Return what encodes messages of a type; raises MessageError where CDR, or ROS, has no word for it."""
    return _Writer(kind, "def encode(message):").whole()


@cache
def writer(kind: type[Message]) -> Write:
    """Return what writes messages of a type within others."""
    return _Writer(kind, "def write(message, out, at):").part()


class _Writer:
    def __init__(self, kind: type[Message], first: str) -> None:
        self._kind = kind
        self._parts = parts(kind)
        self._source = Source(first)
        self._run: list[Part] = []
        self._values: list[str] = []
        self._pieces: list[str] = []
        self._has_out = False
        self._phase: int = 0
        self._terms: list[str] = []
        """with the phase, the place after the header; none where it is known, but for multiples of WORD"""

    def whole(self) -> Callable[[Message], bytes]:
        self._source.line("try:")
        self._source.indent(1)
        self._pieces = [self._source.hold("header", HEADER)]
        self._message(self._kind, "message")
        self._flush()
        if self._has_out:
            self._put()
        self._source.line(f"return b''.join({'out' if self._has_out else self._tuple()})")
        self._source.indent(-1)
        refuse = self._source.hold("refuse", _refuse)
        self._source.line(f"except {self._source.hold('unfit', _UNFIT)} as error:")
        self._source.line(f"    {refuse}({self._kind.__name__!r}, error)")
        return self._source.function("encode", f"<writes {self._kind.ros_type}>")  # type: ignore[no-any-return]

    def part(self) -> Write:
        self._has_out, self._terms = True, ["at"]
        self._message(self._kind, "message")
        self._flush()
        self._put()
        self._source.line(f"return {self._place()}")
        return self._source.function("write", f"<writes {self._kind.ros_type}>")  # type: ignore[no-any-return]

    def _message(self, kind: type[Message], value: str) -> None:
        fields = declared(kind).fields
        if not fields:
            self._add("B", "0")  # what has no member has this one
        for field in fields:
            self._field(field.type, f"{value}.{field.name}")

    def _field(self, kind: Type, value: str) -> None:
        if kind.array:
            self._array(kind, value)
        elif kind.name in CODES:
            self._add(CODES[kind.name], value)
        elif kind.name == "string":
            self._text(kind, value)
        else:
            name = self._source.name("part")
            self._source.line(f"{name} = {value}")
            self._message(self._inner(kind), name)

    def _inner(self, kind: Type) -> type[Message]:
        if kind.name not in self._parts:
            raise MessageError(f"{self._kind.ros_type} holds a {kind.name}, which CDR tells in several ways")
        return self._parts[kind.name]

    def _array(self, kind: Type, value: str) -> None:
        name, count = self._source.name("items"), self._source.name("count")
        self._source.line(f"{name} = {value}")
        if kind.name == "uint8":
            as_bytes = self._source.hold("as_bytes", _as_bytes)
            self._source.line(f"if type({name}) is not bytes: {name} = {as_bytes}({name})")
        self._source.line(f"{count} = len({name})")
        if kind.array == "fixed":
            self._fixed(kind, name, count)
            return
        if kind.length:
            self._check(f"{count} > {kind.length}", f"at most {kind.length} items", count)
        self._add("I", count)
        self._flush()
        if kind.name == "uint8":
            self._pieces.append(name)
            self._grow(count)
        elif code := CODES.get(kind.name):
            self._items(code, name, count)
        else:
            self._each(kind, name)

    def _items(self, code: str, name: str, count: str) -> None:
        """Write values of one size; where there is none, nothing is aligned."""
        padding = f"{{-({self._place()}) % {WORD}}}x" if struct.calcsize(f"<{code}") == WORD else ""
        pack = self._source.hold("pack", struct.pack)
        piece = self._piece(f"{pack}(f'<{padding}{{{count}}}{code}', *{name}) if {count} else b''")
        self._grow(f"len({piece})")

    def _fixed(self, kind: Type, name: str, count: str) -> None:
        self._check(f"{count} != {kind.length}", f"{kind.length} items", count)
        if kind.name == "uint8":
            self._add("s", name, kind.length)
        elif code := CODES.get(kind.name):
            self._add(code, f"*{name}", kind.length)
        else:
            self._flush()
            self._each(kind, name)

    def _each(self, kind: Type, name: str) -> None:
        write: Any = _text_writer(kind.bound) if kind.name == "string" else writer(self._inner(kind))
        self._put()
        self._settle()
        self._source.line(f"for item in {name}: at = {self._source.hold('write', write)}(item, out, at)")

    def _text(self, kind: Type, value: str) -> None:
        name = self._source.name("text")
        self._source.line(f"{name} = {value}.encode()")
        if kind.bound:
            self._check(f"len({value}) > {kind.bound}", f"at most {kind.bound} characters", f"len({value})")
        self._add("I", f"len({name}) + 1")
        self._flush()
        self._pieces.append(name)
        self._grow(f"len({name})")
        self._run.append(_END)

    def _check(self, wrong: str, expected: str, found: str) -> None:
        refuse = self._source.hold("refuse", _refuse_size)
        self._source.line(f"if {wrong}: {refuse}({expected!r}, {found})")

    def _add(self, code: str, value: str, count: int | None = None) -> None:
        self._run.append(Part(code, 1 if count is None else count))
        self._values.append(value)

    def _flush(self) -> None:
        """Write the run of values that has come together."""
        if not self._run:
            return
        if self._terms:
            packs = [found.packed.pack for found in runs(self._run, "<")]
            how, end = f"{self._source.hold('packs', packs)}[{self._place()} & {WORD - 1}]", None
        else:
            found = run(self._run, self._phase, "<")
            how, end = self._source.hold("pack", found.packed.pack), found.phase
        piece = self._piece(f"{how}({', '.join(self._values)})")
        end = end_of(self._run, None) if end is None else end
        if end is None:
            self._grow(f"len({piece})")
        else:
            self._phase, self._terms = end, []
        self._run, self._values = [], []

    def _piece(self, value: str) -> str:
        name = self._source.name("piece")
        self._source.line(f"{name} = {value}")
        self._pieces.append(name)
        return name

    def _put(self) -> None:
        if self._pieces:
            self._source.line(f"out += {self._tuple()}" if self._has_out else f"out = [*{self._tuple()}]")
        self._pieces, self._has_out = [], True

    def _tuple(self) -> str:
        return f"({', '.join(self._pieces)},)"

    def _place(self) -> str:
        return " + ".join([*([str(self._phase)] if self._phase or not self._terms else []), *self._terms])

    def _grow(self, by: str) -> None:
        self._terms.append(by)
        if len(self._terms) > _MOST_TERMS:
            self._settle()

    def _settle(self) -> None:
        self._source.line(f"at = {self._place()}")
        self._phase, self._terms = 0, ["at"]


@cache
def _text_writer(bound: int | None) -> Write:
    def write(text: str, out: list[bytes], at: int) -> int:
        if bound and len(text) > bound:
            _refuse_size(f"at most {bound} characters", len(text))
        data = text.encode()
        out += (bytes(-at % 4), _LENGTH(len(data) + 1), data, b"\0")
        return at + -at % 4 + len(data) + 5

    return write


def _as_bytes(items: Any) -> bytes:
    len(items)  # for a number is no array
    try:
        return bytes(items)
    except ValueError as error:
        raise OverflowError(str(error)) from None


def _refuse_size(expected: str, found: int) -> None:
    raise MessageError(f"expected {expected}, found {found}")


def _refuse(name: str, error: Exception) -> None:
    raise MessageError(f"cannot write {name}: {error}") from None
