import argparse

from zteleop.bus.escape import printable
from zteleop.bus.presence import Endpoint
from zteleop.cli import _options
from zteleop.cli._graph import graph
from zteleop.errors import BusError

EXAMPLES = (
    "zteleop service list --include-hidden-services",
    "zteleop service list --show-types --include-hidden-services",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="with the type of each")
    parser.add_argument("-c", "--count-services", action="store_true", help="say only how many")
    parser.add_argument(
        "-a", "--include-hidden-services", action="store_true", help="also those of every node's parameters"
    )


def run(arguments: argparse.Namespace) -> None:
    with graph(arguments) as found:
        known = found.all_services if arguments.include_hidden_services else found.services
    services = sorted({_line(one, arguments.show_types) for one in known if _is_meant(one, arguments.robot)})
    if arguments.count_services:
        print(len(services))
    elif services:
        print(printable("\n".join(services), keep="\n"))
    elif arguments.robot not in {None, *(node.robot for node in found.nodes)} or not found.nodes:
        raise BusError(found.nobody(arguments.robot))
    else:
        raise BusError("nobody here serves anything but parameters: zteleop param list")


def _is_meant(one: Endpoint, robot: str | None) -> bool:
    return robot in (None, one.robot)


def _line(one: Endpoint, show_types: bool) -> str:
    return f"/{one.robot}/{one.topic}" + (f" [{one.type}]" if show_types else "")
