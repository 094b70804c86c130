import argparse
from collections.abc import Callable, Sequence

import msgspec

from zteleop.bus import clock, presence
from zteleop.bus.lane.call import Call
from zteleop.bus.node import Node
from zteleop.cli import _options
from zteleop.cli._company import who_is_here
from zteleop.cli._painter import HEARD_WITHIN, Painter
from zteleop.config import Config
from zteleop.control.report import to_vehicle
from zteleop.drivers import tick_us
from zteleop.inputs import Drive
from zteleop.inputs.keyboard import Keyboard
from zteleop.inputs.keymap import HELD, KEYMAPS, describe, keymap
from zteleop.machine.guardian import guarded
from zteleop.messages import Vehicle
from zteleop.nodes.teleop import Teleop
from zteleop.screen.dashboard import Dashboard
from zteleop.screen.top_view import Mark
from zteleop.screen.view import View

EXAMPLES = (
    "zteleop keyboard",
    "zteleop keyboard --robot archangel --drive hold",
)
KILLED = "\r\nzteleop was killed; this terminal is as it was, and Enter brings its prompt\r\n"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.epilog = f"{key_table()}\n\n{parser.epilog}"
    parser.add_argument("--keymap", choices=[*KEYMAPS], help="which keys do what (default: all)")
    parser.add_argument(
        "--drive",
        choices=["step", "hold"],
        help="step: every press moves a lever, and there it stays; hold: drive while a key is held "
        "(default: hold where the terminal tells releases, or nothing takes steps; else step)",
    )


def key_table(name: str = "all") -> str:
    """Return what each key of a map does."""
    told = describe(keymap(name))
    room = max(len(keys) for keys, _ in told) + 2
    return "\n  ".join([f"keys of {name}:", *(f"{keys:<{room}}{does}" for keys, does in told)])


def run(arguments: argparse.Namespace) -> None:
    settings = _options.load(arguments)
    if arguments.keymap:
        settings = msgspec.structs.replace(settings, keymap=arguments.keymap)
    with _options.join("keyboard", settings) as node:
        drive_with_keys(node, settings, arguments.drive)


def drive_with_keys(
    node: Node,
    settings: Config,
    drive: Drive | None = None,
    floor: Sequence[Mark] = (),
    watch: Callable[[View], None] = lambda view: None,
) -> Drive:
    """Show the keyboard screen, with what lies on the floor, and drive until the operator has enough.

    Return how: unless somebody said so, while keys are held where their release is told, else in steps
    what takes them.
    """
    node.log.show = lambda line: None  # nothing prints over the screen: it shows the log itself
    keyboard = Keyboard(
        speeds=settings.speeds, steps=settings.steps, keymap=settings.keymap, keys=settings.keys
    )
    known = Dashboard(
        robot=node.robot or "",
        drive="step",
        speeds=settings.speeds,
        steps=settings.steps,
        floor=floor,
        bound=keyboard.bound,
    )
    terminal = keyboard.terminal
    with guarded(terminal.name, terminal.farewell + KILLED), keyboard, Call(settings.bus) as lane:
        keyboard.settle(clock.now)
        paint = Painter(keyboard, known)
        paint(View())
        vehicle = find_vehicle(node, settings)
        if not node.membership.heard().vehicle:
            here = presence.robots(node.membership.session)
            paint.known = known._replace(others=who_is_here(here))
        keyboard.settle(clock.now)  # once more: what was typed while nobody looked

        def show(view: View) -> None:
            watch(view)
            if keyboard.suspending:
                keyboard.suspend(clock.now())  # its last word is said
            else:
                paint(view)

        steps = vehicle.takes_ticks and not keyboard.tells_releases and settings.keymap not in HELD
        keyboard.drive = drive or ("step" if steps else "hold")
        Teleop(node, keyboard, "keyboard", vehicle, show, lane).run()
    return keyboard.drive


def find_vehicle(node: Node, settings: Config) -> Vehicle:
    """Return what the robot says of itself; when it is not there yet, what the settings say."""
    give_up = clock.now() + HEARD_WITHIN
    while clock.now() < give_up:
        if vehicle := node.membership.heard().vehicle:
            return vehicle
        node.spin(0.01)
    return to_vehicle(
        settings.drive, tick_us(settings.driver, settings.driver_settings(settings.driver, "any"))
    )
