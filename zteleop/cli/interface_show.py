import argparse

from zteleop.interfaces.definition import Comments, definition
from zteleop.messages import message_type

EXAMPLES = (
    "zteleop interface show geometry_msgs/msg/Twist",
    "zteleop interface show DriveStatus --all-comments",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("type", help="such as geometry_msgs/msg/Twist, or Twist")
    parser.add_argument("--all-comments", action="store_true", help="also those of the messages within it")
    parser.add_argument("--no-comments", action="store_true", help="without what its source says of it")


def run(arguments: argparse.Namespace) -> None:
    comments: Comments = "all" if arguments.all_comments else "none" if arguments.no_comments else "first"
    print(definition(message_type(arguments.type), comments))
