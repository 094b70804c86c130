import argparse
from collections.abc import Sequence

from zteleop.bus import presence
from zteleop.bus.escape import printable
from zteleop.bus.session import open_session
from zteleop.cli import _company, _options
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
            raise BusError(_who_is_missing({one.robot for one in known}, settings.robot, session.unreached()))
        for robot, node in nodes:
            found = NodeParameters(session, robot, node)
            if not arguments.node:
                print(f"{found.name}:")
            print(printable("\n".join(f"  {name}" for name in found.names()), keep="\n"), flush=True)


def _who_is_missing(robots: set[str], robot: str | None, unreached: Sequence[str]) -> str:
    here = _company.who_is_here(robots, robot or "", unreached)
    start = "start one with: zteleop demo, or zteleop actuator"
    return f"no node with parameters is heard; {here if robots or unreached else start}"
