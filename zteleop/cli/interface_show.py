import argparse

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._types import find_type, service_of
from zteleop.interfaces.definition import Comments, definition

EXAMPLES = (
    "zteleop interface show geometry_msgs/msg/Twist",
    "zteleop interface show std_srvs/srv/SetBool",
    "zteleop interface show DriveStatus --all-comments",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument(
        "type", help="such as geometry_msgs/msg/Twist, or Twist, or what somebody here speaks"
    )
    parser.add_argument("--all-comments", action="store_true", help="also those of the messages within it")
    parser.add_argument("--no-comments", action="store_true", help="without what its source says of it")


def run(arguments: argparse.Namespace) -> None:
    comments: Comments = "all" if arguments.all_comments else "none" if arguments.no_comments else "first"
    kinds = service_of(arguments.type) or [find_type(arguments.type, _options.load(arguments).bus)]
    print(printable("\n---\n".join(definition(kind, comments) for kind in kinds), keep="\n\t"))
