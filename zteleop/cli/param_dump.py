import argparse

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._params import parameters_of
from zteleop.interfaces.parameters import to_python
from zteleop.text.parameter_text import dump

EXAMPLES = (
    "zteleop param dump actuator",
    "zteleop param dump archangel/watchdog",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("node", help="such as archangel/actuator, or actuator with --robot")


def run(arguments: argparse.Namespace) -> None:
    with parameters_of(arguments) as node:
        names = node.names()
        values = dict(zip(names, map(to_python, node.get(names)), strict=True))
    print(printable(dump(node.name, values).rstrip("\n"), keep="\n"))
