import argparse
from collections.abc import Callable, Sequence

import msgspec

from zteleop.bus.node import Node
from zteleop.cli import _options
from zteleop.cli._driving import drive_at_terminal
from zteleop.config import Config
from zteleop.inputs import Drive
from zteleop.inputs.keyboard import Keyboard
from zteleop.inputs.keymap import HELD, KEYMAPS, describe, keymap
from zteleop.messages import Vehicle
from zteleop.screen.dashboard import Dashboard, Task
from zteleop.screen.top_view import Mark
from zteleop.screen.view import View
from zteleop.terminal.typed import Keys, Typed, open_terminal

EXAMPLES = (
    "zteleop keyboard",
    "zteleop keyboard --robot archangel --drive hold",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.epilog = f"{key_table()}\n\n{parser.epilog}"
    parser.add_argument(
        "--input",
        choices=["terminal", "evdev", "stdin"],
        default="terminal",
        help="evdev: releases from the keyboards of this Linux machine, for a terminal that tells none; "
        "stdin: keys from a pipe, without a screen",
    )
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
        drive_with_keys(node, settings, arguments.drive, typed=typed_at(arguments.input))


def typed_at(name: str) -> Keys:
    """Return where the keys come from; raises DeviceError where there are none."""
    if name == "stdin":
        from zteleop.terminal.piped import PipedTerminal

        return Typed(PipedTerminal())
    typed = Typed(open_terminal())
    if name == "terminal":
        return typed
    from zteleop.inputs.evdev.told_keys import ToldKeys

    return ToldKeys(typed)


def drive_with_keys(
    node: Node,
    settings: Config,
    drive: Drive | None = None,
    floor: Sequence[Mark] = (),
    watch: Callable[[View], None] = lambda view: None,
    typed: Keys | None = None,
    task: Callable[[], Task] = Task,
) -> Drive:
    """Show the keyboard screen, with what lies on the floor, and drive until the operator has enough.

    What `task` says, if anything, stands above all else.

    Return how: unless somebody said so, while keys are held where their release is told, else in steps
    what takes them.
    """
    keyboard = Keyboard(
        speeds=settings.speeds,
        steps=settings.steps,
        keymap=settings.keymap,
        keys=settings.keys,
        typed=typed,
    )
    known = Dashboard(
        robot=node.robot or "",
        drive="step",
        speeds=settings.speeds,
        steps=settings.steps,
        floor=floor,
        bound=keyboard.bound,
    )

    def choose(vehicle: Vehicle) -> None:
        steps = vehicle.takes_ticks and not keyboard.tells_releases and settings.keymap not in HELD
        keyboard.drive = drive or ("step" if steps else "hold")

    drive_at_terminal(node, settings, keyboard, "keyboard", known, choose, watch, task)
    return keyboard.drive
