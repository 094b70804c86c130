import argparse

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._params import parameters_of
from zteleop.interfaces.parameters import sentence, to_python

EXAMPLES = (
    "zteleop param get actuator limits.speed",
    "zteleop param get archangel/actuator log_level --hide-type",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("node", help="such as archangel/actuator, or actuator with --robot")
    parser.add_argument("parameter", help="its name: zteleop param list shows them")
    parser.add_argument("--hide-type", action="store_true", help="the value alone")


def run(arguments: argparse.Namespace) -> None:
    with parameters_of(arguments) as node:
        (value,) = node.get([arguments.parameter])
    print(printable(str(to_python(value)) if arguments.hide_type else sentence(value)))
