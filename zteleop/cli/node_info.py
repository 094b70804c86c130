import argparse
from collections.abc import Iterable

from zteleop.bus.escape import printable
from zteleop.bus.presence import RECORDER, Endpoint
from zteleop.cli import _options
from zteleop.cli._graph import Graph, find_node, graph

EXAMPLES = (
    "zteleop node info actuator",
    "zteleop node info /archangel/watchdog",
)
GROUPS = {"sub": "Subscribers", "pub": "Publishers", "srv": "Service Servers"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("node", help="such as archangel/actuator, or actuator with --robot")


def run(arguments: argparse.Namespace) -> None:
    with graph(arguments) as found:
        robot, node = find_node(arguments.node, found.nodes, found.robot)
    for line in lines(robot, node, found):
        print(printable(line))


def lines(robot: str, node: str, found: Graph) -> Iterable[str]:
    """Yield what a node publishes and hears, as ros2 does, and which processes run it."""
    yield f"/{robot}/{node}"
    for kind, title in GROUPS.items():
        yield f"  {title}:"
        known = [*found.endpoints, *found.all_services]
        members = {one for one in known if (one.robot, one.node, one.kind) == (robot, node, kind)}
        yield from sorted({_line(one) for one in members})
        if (node, kind) == (RECORDER, "sub"):
            yield f"    whatever is said on /{robot}, and counts nowhere as one who hears it"
    yield "  Processes:"
    yield from sorted(f"    {one.process}" for one in found.nodes if (one.robot, one.node) == (robot, node))


def _line(one: Endpoint) -> str:
    return f"    /{one.robot}/{one.topic}: {one.type}"
