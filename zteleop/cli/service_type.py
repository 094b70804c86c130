import argparse

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._graph import graph

EXAMPLES = (
    "zteleop service type actuator/set_parameters --robot archangel",
    "zteleop service type /archangel/actuator/list_parameters",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("service", help="such as archangel/lights, or lights with --robot")


def run(arguments: argparse.Namespace) -> None:
    with graph(arguments) as found:
        _, servers = found.service(arguments.service)
    print(printable("\n".join(sorted({one.type for one in servers})), keep="\n"))
