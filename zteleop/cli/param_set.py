import argparse

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._params import parameters_of
from zteleop.errors import BusError
from zteleop.messages import Parameter
from zteleop.text.parameter_text import typed

EXAMPLES = (
    "zteleop param set actuator limits.speed 0.3",
    "zteleop param set archangel/actuator log_level warn",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("node", help="such as archangel/actuator, or actuator with --robot")
    parser.add_argument("parameter", help="its name: zteleop param list shows them")
    parser.add_argument("value", help="YAML: 0.3, true, warn")


def run(arguments: argparse.Namespace) -> None:
    with parameters_of(arguments) as node:
        (described,) = node.describe([arguments.parameter])
        value = typed(arguments.value, described.type)
        (result,) = node.set([Parameter(arguments.parameter, value)])
    if not result.successful:
        raise BusError(f"Setting parameter failed: {result.reason}")
    print(printable("Set parameter successful"))
