"""The values in ROS's interface text: what a constant is, and what a field starts as."""

import re
from typing import TYPE_CHECKING, Any

from zteleop.errors import MessageError

if TYPE_CHECKING:
    from zteleop.interfaces.msg_text import Type

_QUOTED = r""""(?:[^"\\]|\\.)*"|'(?:[^'\\]|\\.)*'"""
_CODE = rf"(?:[^#\"']|{_QUOTED})*"
_WORDS = rf"({_QUOTED})\s*(?:#.*)?"
_ITEM = rf"(\s*(?:{_QUOTED})\s*|[^,]*)(?:,|$)"
STRINGS, FLOATS = ("string", "wstring"), ("float32", "float64")
INTEGERS = {"byte": (0, 255), "char": (0, 255)}
"""by ROS's name: the least and the most a whole number may be"""
INTEGERS |= {f"uint{bits}": (0, 2**bits - 1) for bits in (8, 16, 32, 64)}
INTEGERS |= {f"int{bits}": (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for bits in (8, 16, 32, 64)}
_TRUTH = {"true": True, "1": True, "false": False, "0": False}


def without_comment(text: str) -> str:
    """Return what stands before a comment; a # between quotes begins none."""
    found = re.match(_CODE, text)
    end = found.end() if found else 0
    if text[end : end + 1] in ("", "#"):
        return text[:end].strip()
    return text.partition("#")[0].strip()  # behind a quote that does not end


def constant(text: str, kind: "Type") -> Any:
    """Return a constant's value: a text without quotes goes on to the end of the line, as ROS 1's do."""
    if kind.array or "/" in kind.name:
        raise MessageError("a constant is one number, truth value or text; found one of another type")
    if kind.name not in STRINGS:
        return _one(without_comment(text), kind)
    quoted = re.fullmatch(_WORDS, text)
    return _bounded(_unquoted(quoted[1]) if quoted else text, kind)


def default(text: str, kind: "Type") -> Any:
    """Return what a field starts as; a tuple for an array."""
    if "/" in kind.name:
        raise MessageError(f"a message within another has no default, found {text!r:.80}")
    if not kind.array:
        return _one(text, kind)
    if not (text.startswith("[") and text.endswith("]") and len(text) > 1):
        raise MessageError(f"expected a default such as [1, 2], found {text!r:.80}")
    values = tuple(_one(item, kind) for item in _items(text[1:-1]))
    if kind.length and (len(values) > kind.length or (kind.array == "fixed" and len(values) < kind.length)):
        most = "" if kind.array == "fixed" else "at most "
        raise MessageError(f"expected a default of {most}{kind.length} values, found {len(values)}")
    return values


def _items(text: str) -> list[str]:
    *items, _ = [found[1].strip() for found in re.finditer(_ITEM, text)]  # the last is what ends them
    return items


def _one(text: str, kind: "Type") -> Any:
    if kind.name in STRINGS:
        return _bounded(_text(text), kind)
    if kind.name == "bool":
        if text.lower() not in _TRUTH:
            raise MessageError(f"expected true or false, found {text!r:.80}")
        return _TRUTH[text.lower()]
    return _float(text) if kind.name in FLOATS else _integer(text, kind.name)


def _text(text: str) -> str:
    if text and text[0] not in "\"'":
        return text
    if not re.fullmatch(_QUOTED, text):
        raise MessageError(f"expected a text that ends with the quote it begins with, found {text!r:.80}")
    return _unquoted(text)


def _unquoted(text: str) -> str:
    return text[1:-1].replace(f"\\{text[0]}", text[0])


def _bounded(text: str, kind: "Type") -> str:
    if kind.bound and len(text) > kind.bound:
        raise MessageError(f"expected at most {kind.bound} characters, found {len(text)}")
    return text


def _float(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise MessageError(f"expected a number, found {text!r:.80}") from None


def _integer(text: str, name: str) -> int:
    least, most = INTEGERS[name]
    for base in (10, 0):
        try:
            value = int(text, base)
        except ValueError:
            continue
        if least <= value <= most:
            return value
    raise MessageError(f"expected a whole number from {least} to {most}, found {text!r:.80}")
