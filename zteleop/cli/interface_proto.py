import argparse

from zteleop.messages import message_type
from zteleop.messages.message import plain
from zteleop.text.rendering import to_yaml

EXAMPLES = (
    "zteleop interface proto geometry_msgs/msg/Twist",
    "zteleop interface proto Pwm",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("type", help="such as geometry_msgs/msg/Twist, or Twist")


def run(arguments: argparse.Namespace) -> None:
    print(f'"{to_yaml(plain(message_type(arguments.type).zero()))}"')
