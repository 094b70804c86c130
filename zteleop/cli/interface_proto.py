import argparse

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._types import find_type
from zteleop.interfaces.defaults import with_defaults
from zteleop.interfaces.values import fill
from zteleop.messages.message import plain
from zteleop.text.rendering import to_yaml

EXAMPLES = (
    "zteleop interface proto geometry_msgs/msg/Twist",
    "zteleop interface proto Pwm",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument(
        "type", help="such as geometry_msgs/msg/Twist, or Twist, or what somebody here speaks"
    )


def run(arguments: argparse.Namespace) -> None:
    kind = find_type(arguments.type, _options.load(arguments).bus)
    text = printable(to_yaml(plain(fill(kind, with_defaults(kind, {})))), keep="\n")
    print(f'"{text}"')
