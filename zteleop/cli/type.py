import argparse

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._graph import graph, types_of

EXAMPLES = (
    "zteleop type drive_status",
    "zteleop type archangel/cmd_vel",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("topic", help="such as archangel/odom, or odom with --robot")


def run(arguments: argparse.Namespace) -> None:
    with graph(arguments) as found:
        _, members = found.topic(arguments.topic)
    print(printable("\n".join(types_of(members)), keep="\n"))
