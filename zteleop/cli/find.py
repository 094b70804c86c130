import argparse

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._graph import graph, types_of
from zteleop.errors import BusError, nearest
from zteleop.messages import is_called

EXAMPLES = (
    "zteleop find geometry_msgs/msg/Twist",
    "zteleop find DriveStatus --count-topics",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("type", help="such as nav_msgs/msg/Odometry, or Odometry")
    parser.add_argument("-c", "--count-topics", action="store_true", help="say only how many")


def run(arguments: argparse.Namespace) -> None:
    with graph(arguments) as there:
        types = {topic: types_of(members) for topic, members in there.topics().items()}
    found = [topic for topic, those in types.items() if any(is_called(one, arguments.type) for one in those)]
    if arguments.count_topics:
        print(len(found))
        return
    if not found:
        known = {one for those in types.values() for one in those}
        raise BusError(f"no topic here carries {arguments.type}; {nearest(arguments.type, known)}")
    print(printable("\n".join(found), keep="\n"))
