import argparse

from zteleop.errors import MessageError, nearest
from zteleop.messages import MESSAGES
from zteleop.messages.service import is_half

EXAMPLES = (
    "zteleop interface list",
    "zteleop interface list geometry_msgs",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("package", nargs="?", help="only those of one package, such as geometry_msgs")


def run(arguments: argparse.Namespace) -> None:
    known = sorted(name for name in MESSAGES if not is_half(name))
    packages = {name.partition("/")[0] for name in known}
    if arguments.package not in (None, *packages):
        raise MessageError(f"no package {arguments.package!r}; {nearest(arguments.package, packages)}")
    print("Messages:")
    for name in known:
        if arguments.package in (None, name.partition("/")[0]):
            print(f"    {name}")
