import argparse
from pathlib import Path

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._params import parameters_of
from zteleop.cli._text import read_text
from zteleop.errors import BusError, ConfigError, nearest
from zteleop.text.parameter_text import load, nodes

EXAMPLES = (
    "zteleop param load actuator actuator.yaml",
    "zteleop param load archangel/actuator all.yaml --no-use-wildcard",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("node", help="such as archangel/actuator, or actuator with --robot")
    parser.add_argument("file", type=Path, help="such as zteleop param dump prints it")
    parser.add_argument(
        "--no-use-wildcard", action="store_true", help="pass over what is for /** or the like"
    )


def run(arguments: argparse.Namespace) -> None:
    text = read_text(arguments.file)
    with parameters_of(arguments) as node:
        wildcards, leaf = not arguments.no_use_wildcard, node.name.rpartition("/")[2]
        wanted = load(text, node.name, wildcards=wildcards) or load(text, f"/{leaf}", wildcards=wildcards)
        if not wanted:
            near = nearest(node.name, nodes(text))
            raise ConfigError(f"{arguments.file} has no parameters of {node.name}; {near}")
        results = node.set(wanted)
    failed = [result.reason for result in results if not result.successful]
    for parameter, result in zip(wanted, results, strict=True):
        if result.successful:
            print(printable(f"Set parameter {parameter.name} successful"))
    if failed:
        raise BusError("Setting parameter failed: " + "; ".join(failed))
