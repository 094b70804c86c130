"""The text in which ROS declares its interfaces: what .msg, .srv and .action files say.

ROS 1's words are understood too: `time`, `duration`, and `Header` of no package, which is std_msgs's.
"""

import re
from collections.abc import Iterable
from typing import Any, Literal, NamedTuple

from msgspec import NODEFAULT

from zteleop.errors import MessageError
from zteleop.interfaces import literals
from zteleop.messages.service import REQUEST, RESPONSE

PLAIN = frozenset(["bool", *literals.INTEGERS, *literals.FLOATS, *literals.STRINGS])
"""the types that are not messages"""
NO_DEFAULT: Any = NODEFAULT
PARTS: dict[str, tuple[str, ...]] = {
    "msg": ("",),
    "srv": (REQUEST, RESPONSE),
    "action": ("_Goal", "_Result", "_Feedback"),
}
"""by kind: what stands behind the name of an interface in the types of its parts"""
_ENDS = (*PARTS["srv"], *PARTS["action"])
MOST = 2**32 - 1
"""characters or items, for a length travels in 32 bits"""
NAME = "[A-Za-z][A-Za-z0-9_]*"
_TYPE = re.compile(
    rf"(?P<name>{NAME}(/{NAME}){{0,2}})(<=(?P<bound>[0-9]+))?(?P<array>\[(?P<most><=)?(?P<length>[0-9]*)\])?"
)
_LINE = re.compile(rf"\s*(?P<type>[^\s#]+)\s+(?P<name>{NAME})(?=[\s=#]|$)\s*(?P<rest>.*)", re.DOTALL)
_ROS_1 = {
    "Header": "std_msgs/msg/Header",
    "duration": "builtin_interfaces/msg/Duration",
    "time": "builtin_interfaces/msg/Time",
}
_Lines = list[tuple[int, str]]


class Type(NamedTuple):
    """What a field holds: a plain type or a message, one or an array of them."""

    name: str
    """One of PLAIN, else a full ROS type such as geometry_msgs/msg/Vector3."""
    bound: int | None = None
    """Of a string: at most so many characters."""
    array: Literal["", "fixed", "bounded", "unbounded"] = ""
    length: int | None = None
    """Of a fixed or bounded array."""

    @property
    def text(self) -> str:
        """What a .msg file says of it: `string<=20`, `geometry_msgs/Point[3]`."""
        name = self.name.replace("/msg/", "/") + (f"<={self.bound}" if self.bound else "")
        if not self.array:
            return name
        length = {"fixed": str(self.length), "bounded": f"<={self.length}", "unbounded": ""}[self.array]
        return f"{name}[{length}]"


class Field(NamedTuple):
    type: Type
    name: str
    default: Any = NO_DEFAULT
    """NO_DEFAULT where the text gives none; of an array, a tuple."""


class Constant(NamedTuple):
    type: Type
    name: str
    value: Any


class Definition(NamedTuple):
    """A message, or one part of a service or an action."""

    ros_type: str
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...]


def parse_message(text: str, ros_type: str) -> Definition:
    """Return what the text of a .msg file declares; raises MessageError with the line that is none."""
    return _definition(_lines(text), ros_type, ros_type)


def parse_service(text: str, ros_type: str) -> tuple[Definition, Definition]:
    """Return request and response of a .srv file."""
    request, response = _parts(text, ros_type, PARTS["srv"])
    return request, response


def parse_action(text: str, ros_type: str) -> tuple[Definition, Definition, Definition]:
    """Return goal, result and feedback of an .action file."""
    goal, result, feedback = _parts(text, ros_type, PARTS["action"])
    return goal, result, feedback


def parse_type(text: str, package: str) -> Type:
    """Return the type that a field of a package's message is declared as."""
    found = _TYPE.fullmatch(text)
    if not found:
        raise MessageError(
            f"expected a type such as int32, string<=10, float64[3] or Pose[], found {text!r:.80}"
        )
    name = _full_name(found["name"], package)
    bound = _size(found["bound"], text) if found["bound"] else None
    if bound and name not in literals.STRINGS:
        raise MessageError(f"only a string has a bound; found {text!r:.80}")
    if not found["array"]:
        return Type(name, bound)
    if not found["length"] and not found["most"]:
        return Type(name, bound, "unbounded")
    return Type(name, bound, "bounded" if found["most"] else "fixed", _size(found["length"], text))


def _full_name(name: str, package: str) -> str:
    parts = name.split("/")
    if len(parts) == 1:
        return name if name in PLAIN else _ROS_1.get(name, f"{package}/msg/{name}")
    if len(parts) == 3 and parts[1] in PARTS and name.endswith(_ENDS):
        return name
    if len(parts) == 3 and parts[1] != "msg":
        raise MessageError(f"a field is of a message, package/msg/Name; found {name!r:.80}")
    return f"{parts[0]}/msg/{parts[-1]}"


def _size(digits: str, text: str) -> int:
    size = int(digits) if 0 < len(digits) <= len(str(MOST)) else 0
    if not 0 < size <= MOST:
        raise MessageError(f"expected a length from 1 to {MOST}, found {text!r:.80}")
    return size


def _lines(text: str) -> _Lines:
    return list(enumerate(text.removeprefix("\ufeff").split("\n"), 1))


def _parts(text: str, ros_type: str, ends: tuple[str, ...]) -> list[Definition]:
    parts: list[_Lines] = [[]]
    for number, line in _lines(text):
        if re.fullmatch(r"\s*-{3,}\s*(#.*)?", line):
            parts.append([])
        else:
            parts[-1].append((number, line))
    if len(parts) != len(ends):
        raise MessageError(
            f"{ros_type}: expected {len(ends)} parts with a line --- between them, found {len(parts)}"
        )
    return [_definition(lines, ros_type, ros_type + end) for lines, end in zip(parts, ends, strict=True)]


def _definition(lines: Iterable[tuple[int, str]], of: str, ros_type: str) -> Definition:
    fields: list[Field] = []
    constants: list[Constant] = []
    names: set[str] = set()
    for number, line in lines:
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        try:
            found = _member(line, ros_type.partition("/")[0])
            if found.name in names:
                raise MessageError(f"there are two of the name {found.name}")
        except MessageError as error:
            raise MessageError(f"{of}, line {number}: {error}") from None
        names.add(found.name)
        if isinstance(found, Field):
            fields.append(found)
        else:
            constants.append(found)
    return Definition(ros_type, tuple(fields), tuple(constants))


def _member(line: str, package: str) -> Field | Constant:
    found = _LINE.fullmatch(line)
    if not found:
        raise MessageError(f"expected a type and a name, such as float64 x, found {line.strip()!r:.80}")
    kind, name, rest = parse_type(found["type"], package), found["name"], found["rest"]
    if rest.startswith("="):
        return Constant(kind, name, literals.constant(rest[1:].strip(), kind))
    given = literals.without_comment(rest)
    return Field(kind, name, literals.default(given, kind) if given else NO_DEFAULT)
