import argparse

from zteleop.bus.node import Node
from zteleop.cli import _options
from zteleop.cli._alone import expect_alone
from zteleop.config import Config
from zteleop.nodes.dead_reckoner import DeadReckoner

EXAMPLES = (
    "zteleop odometry",
    "zteleop odometry --robot archangel",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    _options.add_parent(parser)


def run(arguments: argparse.Namespace) -> None:
    settings = _options.load(arguments)
    with _options.join("odometry", settings, settle=True) as node:
        expect_alone(node)
        _options.end_with_parent(arguments, node)
        reckon(node, settings)


def reckon(node: Node, settings: Config) -> None:
    """Say where a robot should be until the node is stopped."""
    robot = node.robot

    def tell(goes_by: str) -> None:
        node.log.info(f"says where {robot} should be, by {goes_by}: an estimate, which drifts")

    DeadReckoner(node, settings.odometry, tell)
    node.spin()
