import argparse
import sys
from collections.abc import Sequence

from zteleop.bus import presence
from zteleop.bus.escape import printable
from zteleop.bus.node_parameters import NodeParameters
from zteleop.bus.session import open_session
from zteleop.cli import _options
from zteleop.cli._graph import find_node
from zteleop.errors import BusError

EXAMPLES = (
    "zteleop param list",
    "zteleop param list actuator",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("node", nargs="?", help="such as archangel/actuator (default: all)")


def run(arguments: argparse.Namespace) -> int:
    """Print the parameters of each node; return 1 where one of several does not answer."""
    settings = _options.load_anyhow(arguments)
    with open_session(settings.bus, settle=True) as session:
        known = presence.with_parameters(session)
        if arguments.node:
            nodes = [find_node(arguments.node, known, settings.robot)]
        else:
            there = {(one.robot, one.node) for one in known if settings.robot in (None, one.robot)}
            nodes = sorted(there)
        if not nodes:
            raise BusError(_who_is_missing({one.robot for one in known}, settings.robot, session.unreached()))
        if arguments.node:
            _tell(NodeParameters(session, *nodes[0]))
            return 0
        return max([_tell_of_one(NodeParameters(session, robot, node)) for robot, node in nodes])


def _tell(found: NodeParameters) -> None:
    print(printable("\n".join(f"  {name}" for name in found.names()), keep="\n"), flush=True)


def _tell_of_one(found: NodeParameters) -> int:
    """Tell those of one node among several, of which one that is busy hides no other."""
    print(f"{found.name}:", flush=True)
    try:
        _tell(found)
    except BusError as error:
        print(printable(f"zteleop param list: {error}"), file=sys.stderr, flush=True)
        return 1
    return 0


def _who_is_missing(robots: set[str], robot: str | None, unreached: Sequence[str]) -> str:
    here = presence.who_is_here(robots, robot or "", unreached)
    start = "start one with: zteleop demo, or zteleop actuator"
    return f"no node with parameters is heard; {here if robots or unreached else start}"
