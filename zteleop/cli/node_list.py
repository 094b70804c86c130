import argparse

from zteleop.bus.escape import printable
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
