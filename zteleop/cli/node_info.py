import argparse
from collections.abc import Iterable

from zteleop.bus.escape import printable
from zteleop.bus.presence import Endpoint
from zteleop.cli import _options
from zteleop.cli._graph import Graph, graph
from zteleop.errors import BusError, nearest

EXAMPLES = (
    "zteleop node info actuator",
    "zteleop node info /archangel/watchdog",
)
GROUPS = {"sub": "Subscribers", "pub": "Publishers"}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("node", help="such as archangel/actuator, or actuator with --robot")


def run(arguments: argparse.Namespace) -> None:
    with graph(arguments) as found:
        robot, node = _named(arguments.node, found)
    for line in lines(robot, node, found):
        print(printable(line))


def _named(text: str, found: Graph) -> tuple[str, str]:
    """Return the robot and the name of a node; raises BusError for one that is not there."""
    known = sorted({f"/{node.robot}/{node.node}" for node in found.nodes})
    named = text.strip("/")
    wanted = [one for one in known if one == f"/{named}" or ("/" not in named and one.endswith(f"/{named}"))]
    own = [one for one in wanted if one == f"/{found.robot}/{named}"] or wanted
    if len(own) > 1:
        raise BusError(f"{len(own)} nodes are called {named}: {', '.join(own)}; say which")
    if not own:
        raise BusError(f"Unable to find node '{text}'; {nearest(f'/{named}', known)}")
    _, robot, node = own[0].split("/")
    return robot, node


def lines(robot: str, node: str, found: Graph) -> Iterable[str]:
    """Yield what a node publishes and hears, as ros2 does, and which processes run it."""
    yield f"/{robot}/{node}"
    for kind, title in GROUPS.items():
        yield f"  {title}:"
        members = {one for one in found.endpoints if (one.robot, one.node, one.kind) == (robot, node, kind)}
        yield from sorted({_line(one) for one in members})
    yield "  Processes:"
    yield from sorted(f"    {one.process}" for one in found.nodes if (one.robot, one.node) == (robot, node))


def _line(one: Endpoint) -> str:
    return f"    /{one.robot}/{one.topic}: {one.type}"
