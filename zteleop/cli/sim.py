import argparse

from zteleop import config
from zteleop.bus.node import Node
from zteleop.cli import _options
from zteleop.nodes import simulator


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument("vehicle", nargs="?", choices=["car"], default="car", help="what to simulate")
    _options.add_parent(parser)


def run(arguments: argparse.Namespace) -> None:
    settings = _options.load(arguments)
    robot = settings.robot or config.own_name()
    driver = settings.driver_settings("simulated", robot)
    with Node("sim", robot, settings.bus) as node:
        _options.end_with_parent(arguments, node)
        simulator.run(node, settings.drive, driver["path"])
