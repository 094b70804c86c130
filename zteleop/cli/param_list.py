import argparse

from zteleop.bus import presence
from zteleop.bus.escape import printable
from zteleop.bus.session import open_session
from zteleop.cli import _options
from zteleop.cli._graph import find_node
from zteleop.cli._params import NodeParameters
from zteleop.errors import BusError

EXAMPLES = (
    "zteleop param list",
    "zteleop param list actuator",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("node", nargs="?", help="such as archangel/actuator (default: all)")


def run(arguments: argparse.Namespace) -> None:
    settings = _options.load(arguments)
    with open_session(settings.bus, settle=True) as session:
        known = presence.with_parameters(session)
        if arguments.node:
            nodes = [find_node(arguments.node, known, settings.robot)]
        else:
            there = {(one.robot, one.node) for one in known if settings.robot in (None, one.robot)}
            nodes = sorted(there)
        if not nodes:
            raise BusError(
                "no node with parameters is heard; start one with: zteleop demo, or zteleop actuator"
            )
        for robot, node in nodes:
            found = NodeParameters(session, robot, node)
            if not arguments.node:
                print(f"{found.name}:")
            print(printable("\n".join(f"  {name}" for name in found.names()), keep="\n"), flush=True)
