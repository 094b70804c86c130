import argparse
from pathlib import Path

from zteleop import config
from zteleop.cli import _options, _pages
from zteleop.cli._calibrating import Seat, at_terminal, find_out
from zteleop.cli._calibrating_page import on_a_page
from zteleop.cli._consent import ROOM_AHEAD, WHEELS_UP, ask_consent
from zteleop.cli._donkeycar import export, imported
from zteleop.cli._oscillator import measured
from zteleop.cli._settings_file import Changes, SettingsFile, editor, of_servos, pulses_told
from zteleop.control.measuring import STEPS, TRIM
from zteleop.errors import ConfigError
from zteleop.terminal.typed import open_terminal

EXAMPLES = (
    "zteleop calibrate --to-donkeycar first_myconfig.py",
    "zteleop calibrate --to-donkeycar second_myconfig.py",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add(parser)
    instead = parser.add_mutually_exclusive_group()
    instead.add_argument(
        "--from-donkeycar",
        metavar="FILE",
        type=Path,
        help="turn nothing: take the calibration of a config.py, and of the myconfig.py beside it",
    )
    instead.add_argument(
        "--to-donkeycar",
        metavar="FILE",
        type=Path,
        help="turn nothing: write the calibration as a myconfig.py",
    )
    instead.add_argument(
        "--meter",
        metavar="HZ",
        type=float,
        help="turn nothing: what a meter shows at a channel while the actuator runs makes its oscillator",
    )
    instead.add_argument(
        "--trim", action="store_true", help="drive on the floor, and find out only where it steers straight"
    )
    parser.add_argument("--dry-run", action="store_true", help="write nothing: show what would change")
    parser.add_argument("--web", action="store_true", help="ask on a page in a browser")
    _pages.add(parser)


def run(arguments: argparse.Namespace) -> int:
    """Find out how far servo and motor turn, and write it down; 1 when whoever found out had enough."""
    file = SettingsFile(arguments.config)
    if arguments.to_donkeycar:
        export(file.settings, arguments.to_donkeycar, arguments.dry_run)
        return 0
    changes: Changes | None = None
    if arguments.from_donkeycar:
        changes = dict(imported(file.settings, arguments.from_donkeycar))
    elif arguments.meter is not None:
        changes = dict(measured(file.settings, arguments.meter))
    if changes is not None:
        print("\n".join(kept(file, changes, arguments.dry_run)))
        return 0
    settings = _options.with_typed(arguments, file.settings)
    if not settings.drive.mixer.takes_ticks:
        raise ConfigError(
            "calibrate knows cars, with steering and throttle, and this config makes none: "
            "write the pulses of its motors into [drive.servos] by hand"
        )
    robot = settings.robot or config.own_name()
    editor()
    steps = TRIM if arguments.trim else STEPS
    turns = "drives the car" if arguments.trim else "turns the steering and the motor"
    does = f"This {turns}, by the {settings.driver} chip, as far as the keys say."
    about = ROOM_AHEAD if arguments.trim else WHEELS_UP

    def measure(seat: Seat) -> tuple[int, list[str]]:
        found = find_out(file, settings, robot, steps, seat)
        if found is None:
            return 1, [f"left before the end: {file.path} is as it was, and its neutral is written"]
        return 0, kept(file, of_servos(found), arguments.dry_run)

    place = _pages.place_of(arguments) if arguments.web else None
    if not place and _pages.is_typed(arguments):
        raise ConfigError("where a page is served is for --web: say that as well")
    if place and arguments.trim:
        raise ConfigError("--trim drives on the floor, by the keys of a terminal: say it without --web")
    if place:
        return on_a_page(settings, robot, place, does, about, measure)
    open_terminal()  # what is missing is said before anything turns
    if settings.driver != "simulated":
        ask_consent(does, about)
    code, lines = measure(at_terminal(settings))
    print("\n".join(lines))
    return code


def kept(file: SettingsFile, changes: Changes, dry_run: bool) -> list[str]:
    """Write what was found out into the config file, and return what it is now; or what would change."""
    text, after = file.changed(changes)
    if dry_run:
        return file.difference(text) or [f"{file.path} says so already"]
    before = f"; as it was before it is {file.backup}" if file.text else ", which is new"
    file.write(text)
    hint = (
        ['driver is "simulated": on the car, say driver = "pca9685"'] if after.driver == "simulated" else []
    )
    return [*pulses_told(file.settings, after), f"{file.path} is written{before}", *hint]
