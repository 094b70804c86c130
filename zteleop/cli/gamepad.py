import argparse
import select
import sys

from zteleop.bus import clock
from zteleop.bus.lane.call import Call
from zteleop.bus.node import Node
from zteleop.cli import _options
from zteleop.cli._driving import drive_at_terminal, find_vehicle
from zteleop.cli._telling import teller
from zteleop.config import Config
from zteleop.errors import DeviceError
from zteleop.inputs.console import Console
from zteleop.inputs.gamepad import Gamepad
from zteleop.inputs.gamepad_learn import Lesson
from zteleop.inputs.gamepad_map import USES, GamepadSettings, Pads
from zteleop.inputs.keyboard import Keyboard
from zteleop.nodes.teleop import Teleop
from zteleop.screen.dashboard import Dashboard

EXAMPLES = (
    "zteleop gamepad",
    "zteleop gamepad --robot archangel",
)
LOOK_EVERY = 0.05
"""s between two looks at a pad that is being learned"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    parser.add_argument(
        "--input",
        choices=["evdev", "sdl"],
        default="evdev" if sys.platform == "linux" else "sdl",
        help="what tells of pads: evdev is Linux itself, sdl is for macOS (default here: %(default)s)",
    )
    parser.add_argument("--list", action="store_true", help="list the pads of this machine, and end")
    parser.add_argument(
        "--learn", action="store_true", help="ask which control does what, and print it for config.toml"
    )


def run(arguments: argparse.Namespace) -> None:
    settings = _options.load(arguments)
    pads = pads_of(arguments.input, settings.gamepad.device)
    if arguments.list:
        list_pads(pads)
    elif arguments.learn:
        learn(pads)
    else:
        drive = _at_terminal if sys.stdin.isatty() else _alone
        with _options.join("gamepad", settings) as node:
            drive(node, settings, Gamepad(pads, settings.gamepad, settings.speeds))


def _at_terminal(node: Node, settings: Config, pad: Gamepad) -> None:
    """Drive with a screen, whose keys stop, release and quit."""
    keyboard = Keyboard("hold", keymap="stop", keys={})
    known = Dashboard(
        robot=node.robot or "",
        drive="hold",
        speeds=settings.speeds,
        bound=keyboard.bound,
    )
    drive_at_terminal(node, settings, Console(pad, keyboard), "gamepad", known)


def _alone(node: Node, settings: Config, pad: Gamepad) -> None:
    """Drive without a terminal, as a service does: what there is to know goes into its log."""
    with pad, Call(settings.bus) as lane:
        Teleop(node, pad, "gamepad", find_vehicle(node, settings), teller(lambda: pad.words), lane).run()


def pads_of(name: str, which: str) -> Pads:
    """Return where pads are looked for, and of which name."""
    if name == "evdev":
        from zteleop.inputs.evdev.pads import EvdevPads

        return EvdevPads(which)
    from zteleop.inputs.sdl_pads import SdlPads

    return SdlPads(which)


def list_pads(pads: Pads) -> None:
    """Print a line for each pad; raises DeviceError when there is none."""
    with pads:
        names = pads.names
    if not names:
        raise DeviceError("no gamepad is here; plug one in, or switch it on")
    print("\n".join(names))


def learn(pads: Pads) -> None:
    """Ask for one control after the other; print what config.toml needs."""
    lesson, asked = Lesson(), ""
    with pads:
        while not lesson.done:
            words = pads.name and (lesson.complaint or lesson.question)
            words = words or "waiting for a gamepad: plug one in, or switch it on"
            if words != asked:
                asked = words
                print(words, file=sys.stderr, flush=True)
            for moved in pads.read(clock.now()):
                lesson.heed(moved)
            file = pads.fileno()
            select.select([] if file is None else [file], [], [], LOOK_EVERY)
    print(as_toml(lesson.settings))


def as_toml(settings: GamepadSettings) -> str:
    """Return the part of config.toml that says which control does what."""
    return "\n".join(["[gamepad]", *(f'{use} = "{getattr(settings, use)}"' for use in USES)])
