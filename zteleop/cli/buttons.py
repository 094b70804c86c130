import argparse
from collections.abc import Callable

from zteleop.bus.escape import printable
from zteleop.cli import _options
from zteleop.cli._driving import find_vehicle
from zteleop.inputs.buttons import Buttons
from zteleop.messages import InterfaceButtons
from zteleop.nodes.teleop import Teleop
from zteleop.screen.view import View

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
        Teleop(node, buttons, "buttons", find_vehicle(node, settings), teller(buttons)).run()


def teller(buttons: Buttons) -> Callable[[View], None]:
    """Return what prints a line whenever a button, or what the robot makes of it, is another."""
    shown = ""

    def tell(view: View) -> None:
        nonlocal shown
        status = view.status
        does = f"{status.state}: {view.refused or status.why}" if status else "no actuator is heard"
        line = f"{'; '.join(buttons.about)}  ->  {does.partition(' for ')[0]}"
        if line != shown:
            shown = line
            print(printable(line), flush=True)

    return tell
