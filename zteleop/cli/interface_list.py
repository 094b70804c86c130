import argparse

from zteleop.errors import MessageError, nearest
from zteleop.interfaces import library
from zteleop.messages import MESSAGES
from zteleop.messages.service import is_half

EXAMPLES = (
    "zteleop interface list",
    "zteleop interface list geometry_msgs",
)

TITLES: dict[library.Kind, str] = {"msg": "Messages", "srv": "Services", "action": "Actions"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package", nargs="?", help="only those of one package, such as geometry_msgs")


def run(arguments: argparse.Namespace) -> None:
    own = {name.partition("/")[0] for name in MESSAGES}
    packages = own.union(library.packages())
    if arguments.package not in (None, *packages):
        raise MessageError(f"no package {arguments.package!r}; {nearest(arguments.package, packages)}")
    wanted = sorted(packages) if arguments.package is None else [arguments.package]
    for kind, title in TITLES.items():
        if names := [name for package in wanted for name in names_of(package, kind)]:
            print(f"{title}:")
            print("\n".join(f"    {name}" for name in names))


def names_of(package: str, kind: library.Kind) -> list[str]:
    """Return the types of a package, by their ROS names: those of zteleop, and all that it has text of."""
    start = f"{package}/{kind}/"
    own = {name for name in MESSAGES if name.startswith(start) and not is_half(name)}
    return sorted(own.union(f"{start}{name}" for name in library.types(package, kind)))
