import argparse
from collections.abc import Iterator

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._params import parameters_of
from zteleop.interfaces.parameters import type_words
from zteleop.messages import FloatingPointRange, IntegerRange, ParameterDescriptor

EXAMPLES = (
    "zteleop param describe actuator limits.speed",
    "zteleop param describe actuator limits.speed log_level",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("node", help="such as archangel/actuator, or actuator with --robot")
    parser.add_argument("parameter", nargs="+", help="its name: zteleop param list shows them")


def run(arguments: argparse.Namespace) -> None:
    with parameters_of(arguments) as node:
        found = node.describe(arguments.parameter)
    for one in found:
        print(printable("\n".join(lines(one)), keep="\n"))


def lines(one: ParameterDescriptor) -> Iterator[str]:
    """Yield what a parameter is and may be, as ros2 does."""
    yield f"Parameter name: {one.name}"
    yield f"  Type: {type_words(one.type)}"
    if one.description:
        yield f"  Description: {one.description}"
    bounds: list[FloatingPointRange | IntegerRange] = [*one.floating_point_range, *one.integer_range]
    if bounds or one.additional_constraints:
        yield "  Constraints:"
    for bound in bounds:
        yield f"    Min value: {bound.from_value}"
        yield f"    Max value: {bound.to_value}"
        if bound.step:
            yield f"    Step: {bound.step}"
    if one.additional_constraints:
        yield f"    Additional constraints: {one.additional_constraints}"
