import argparse
from importlib.metadata import version

from zteleop.bus.lane.call import Call
from zteleop.bus.node import Node
from zteleop.cli import _options, _pages
from zteleop.cli._driving import find_vehicle
from zteleop.config import Config

EXAMPLES = (
    "zteleop web",
    "zteleop web archangel --port 8000",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    _options.add_robot(parser)
    _pages.add(parser)


def run(arguments: argparse.Namespace) -> None:
    place = _pages.place_of(arguments)
    settings = _options.load(arguments)
    with _options.join("web", settings) as node:
        drive_from_page(node, settings, place)


def drive_from_page(node: Node, settings: Config, place: _pages.Place) -> None:
    """Serve a page, print its address, and drive by whatever is held on it until the node is stopped."""
    from zteleop.bridges.web.cockpit import Cockpit

    with Call(settings.bus) as lane:
        cockpit = Cockpit(node, find_vehicle(node, settings), version("zteleop"), lane)
        with _pages.served(cockpit, place, f"drives {node.robot}", node.log.warn):
            cockpit.run()
