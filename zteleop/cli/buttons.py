import argparse
import sys

from zteleop.bus import clock, presence
from zteleop.bus.escape import printable
from zteleop.bus.names import resolve
from zteleop.bus.node import Node
from zteleop.cli import _company, _options
from zteleop.cli._driving import find_vehicle
from zteleop.cli._telling import teller
from zteleop.inputs.buttons import Buttons
from zteleop.messages import InterfaceButtons
from zteleop.nodes.teleop import Teleop

TELL_AFTER = 1.0
"""s until it says who tells of no button"""
EXAMPLES = (
    "zteleop buttons",
    "zteleop buttons archangel",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    _options.add_robot(parser)
    _options.add_parent(parser)


def run(arguments: argparse.Namespace) -> None:
    settings = _options.load(arguments)
    with _options.join("buttons", settings) as node, Buttons(settings.speeds) as buttons:
        _options.end_with_parent(arguments, node)
        node.subscription(
            "interface_buttons", InterfaceButtons, lambda heard: buttons.hear(heard.message, heard.at)
        )
        tell = teller(lambda: "; ".join(buttons.about))
        node.membership.loop.alarm(lambda: _miss(node, buttons)).ring_at(clock.now() + TELL_AFTER)
        Teleop(node, buttons, "buttons", find_vehicle(node, settings), tell).run()


def _miss(node: Node, buttons: Buttons) -> None:
    """Say who tells of no button, or that nobody does."""
    if not buttons.heard:
        name, session = resolve("interface_buttons", node.robot), node.membership.session
        words = _company.why_silent(name, presence.endpoints(session), session.unreached())
        print(printable(f"zteleop buttons: waits for {name}: {words}"), file=sys.stderr, flush=True)
