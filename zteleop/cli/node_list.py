import argparse
import sys
from collections.abc import Iterable

from zteleop.bus.escape import printable
from zteleop.bus.presence import Member
from zteleop.cli import _options
from zteleop.cli._graph import graph
from zteleop.errors import BusError

EXAMPLES = (
    "zteleop node list",
    "zteleop node list --count-nodes",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("-c", "--count-nodes", action="store_true", help="say only how many")


def run(arguments: argparse.Namespace) -> None:
    with graph(arguments) as found:
        nodes = [node for node in found.nodes if arguments.robot in (None, node.robot)]
    if arguments.count_nodes:
        print(len(nodes))
        return
    if not nodes:
        raise BusError(found.nobody(arguments.robot))
    print(printable("\n".join(f"/{node.robot}/{node.node}" for node in nodes), keep="\n"))
    for name, where in namesakes(nodes).items():
        words = f"{len(where)} nodes are called {name}, on {' and '.join(where)}; of a question one answers"
        print(printable(f"zteleop node list: warning: {words}"), file=sys.stderr)


def namesakes(nodes: Iterable[Member]) -> dict[str, list[str]]:
    """Return the names that several nodes have, and on which processes those are."""
    found = dict[str, list[str]]()
    for one in nodes:
        found.setdefault(f"/{one.robot}/{one.node}", []).append(one.process)
    return {name: where for name, where in found.items() if len(where) > 1}
