"""Every interface by its ROS type: the text that comes with zteleop, and that of users' own folders.

A folder that was added later wins over earlier ones and over the text that comes along, but for the types of
zteleop.messages: those stay as they are. What has been asked for once stays as it was.
"""

import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Literal

from zteleop.errors import ConfigError, MessageError, nearest
from zteleop.interfaces import derived
from zteleop.interfaces.msg_text import (
    NAME,
    PARTS,
    Definition,
    parse_action,
    parse_message,
    parse_service,
)
from zteleop.messages import MESSAGES
from zteleop.messages.service import REQUEST, RESPONSE

Kind = Literal["msg", "srv", "action"]
BUNDLED = Path(__file__).with_name("definitions")
IGNORED = ("COLCON_IGNORE", "AMENT_IGNORE")
"""files with which a ROS workspace says that a folder, such as build/, holds no packages"""
_INTERFACE = re.compile(rf"({NAME})/(msg|srv|action)/({NAME})")
_PARSERS: dict[str, Callable[[str, str], tuple[Definition, ...]]] = {
    "msg": lambda text, ros_type: (parse_message(text, ros_type),),
    "srv": parse_service,
    "action": parse_action,
}
_theirs: dict[str, Path] = {}


@cache
def definition(ros_type: str) -> Definition:
    """Return what geometry_msgs/msg/Twist, std_srvs/srv/SetBool_Request or x/action/Dock_Goal is made of.

    So are the messages that ROS makes of those, such as x/action/Dock_SendGoal_Request. Raises MessageError
    when there is no such type, or its file declares none.
    """
    parts = _parts(ros_type)
    if ros_type not in parts:
        ends = (*PARTS[ros_type.split("/")[1]], REQUEST, RESPONSE)
        asked = [name for name in parts if name.removeprefix(ros_type) in ends]
        raise MessageError(f"{ros_type} is more than one message; ask for {' or '.join(asked)}")
    return parts[ros_type]


@cache
def described(ros_type: str) -> Definition:
    """Return what a type is made of in a description, where a whole service or action is a type too."""
    parts = _parts(ros_type)
    if ros_type in parts:
        return parts[ros_type]
    return next(whole for whole in derived.wholes(_interface(ros_type)) if whole.ros_type == ros_type)


def has(ros_type: str) -> bool:
    """Say whether there is such a type."""
    return _path(_interface(ros_type)) is not None


def types(package: str, kind: Kind) -> list[str]:
    """Return the names of a package's messages, services or actions, sorted; none for an unknown package."""
    start = f"{package}/{kind}/"
    own = {name.removeprefix(start) for name in _theirs if name.startswith(start)}
    return sorted(own.union(_bundled(package, kind)))


def packages() -> list[str]:
    """Return the names of all packages, sorted."""
    return sorted({name.partition("/")[0] for name in _theirs}.union(_bundled_packages()))


def add_folder(folder: Path) -> None:
    """Find the interfaces below a folder, which are as in a ROS workspace: .../package/msg/Name.msg.

    Of two with one name the one less deep counts. Raises ConfigError when there are none.
    """
    if not folder.is_dir():
        raise ConfigError(f"expected a folder of .msg, .srv and .action files, found none at {folder}")
    try:
        found = sorted(_below(folder.resolve(), set()), key=lambda path: (len(path.parts), path))
        named = {_named(path): path for path in reversed(found)}
    except OSError as error:
        raise ConfigError(f"cannot look for .msg, .srv and .action files below {folder}: {error}") from None
    if not any(named):
        raise ConfigError(f"expected files such as my_msgs/msg/Name.msg below {folder}, found none")
    _theirs.update({name: path for name, path in named.items() if name})


def _interface(ros_type: str) -> str:
    """Return what a type is a part of: std_srvs/srv/SetBool for its request."""
    found = _INTERFACE.fullmatch(ros_type)
    ends = (*PARTS[found[2]], *derived.ENDS[found[2]]) if found else ()
    return ros_type.removesuffix(next((end for end in ends if ros_type.endswith(end)), ""))


def _parts(ros_type: str) -> dict[str, Definition]:
    """Return all messages of the interface that a type is of."""
    interface = _interface(ros_type)
    path = _path(interface)
    if not path:
        raise MessageError(_unknown(ros_type))
    return {part.ros_type: part for part in (*_parse(path, interface), *derived.messages(interface))}


def _part_types(interface: str) -> list[str]:
    return [interface + end for end in PARTS[interface.split("/")[1]]]


def _path(interface: str) -> Path | None:
    found = _INTERFACE.fullmatch(interface)
    if not found:
        return None
    package, kind, leaf = found.groups()
    bundled = BUNDLED / package / kind / f"{leaf}.{kind}" if leaf in _bundled(package, kind) else None
    if bundled and any(part in MESSAGES for part in _part_types(interface)):
        return bundled
    return _theirs.get(interface, bundled)


@cache
def _parse(path: Path, interface: str) -> tuple[Definition, ...]:
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise MessageError(f"cannot read {path}, which declares {interface}: {error}") from None
    return _PARSERS[interface.split("/")[1]](text, interface)


@cache
def _bundled(package: str, kind: str) -> frozenset[str]:
    folder = BUNDLED / package / kind
    known = package in _bundled_packages() and folder.is_dir()
    return frozenset(path.stem for path in folder.iterdir()) if known else frozenset()


@cache
def _bundled_packages() -> frozenset[str]:
    return frozenset(path.name for path in BUNDLED.iterdir() if path.is_dir())


def _below(folder: Path, seen: set[Path]) -> Iterator[Path]:
    """Yield the files of interfaces below a folder, following links, but into no folder twice."""
    seen.add(folder.resolve())
    for path in sorted(folder.iterdir()):
        if path.is_dir():
            ignored = path.name.startswith(".") or any((path / name).exists() for name in IGNORED)
            if not ignored and path.resolve() not in seen:
                yield from _below(path, seen)
        elif folder.name in PARTS and path.suffix == f".{folder.name}":
            yield path


def _named(path: Path) -> str:
    """Return the ROS type of a file; empty where its names are none that one could have."""
    name = f"{_package(path.parents[1])}/{path.parent.name}/{path.stem}"
    return name if _INTERFACE.fullmatch(name) else ""


def _package(folder: Path) -> str:
    """Return what a package calls itself, whatever its folder is called."""
    about = folder / "package.xml"
    text = about.read_text(encoding="utf-8", errors="replace") if about.is_file() else ""
    found = re.search(rf"<name>\s*({NAME})\s*</name>", text)
    return found[1] if found else folder.name


def _unknown(ros_type: str) -> str:
    package, _, rest = ros_type.partition("/")
    if not rest:
        return f"expected a type such as geometry_msgs/msg/Twist, found {ros_type!r:.80}"
    if package not in packages():
        return f"no package {package!r:.80} of interfaces; {nearest(package, packages())}"
    kinds: tuple[Kind, ...] = ("msg", "srv", "action")
    known = [f"{package}/{kind}/{leaf}" for kind in kinds for leaf in types(package, kind)]
    shown = [part for name in known for part in _part_types(name)]
    return f"no interface {ros_type!r:.80}; {nearest(ros_type, shown)}"
