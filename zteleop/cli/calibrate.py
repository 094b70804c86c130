import argparse
from pathlib import Path

from zteleop import config
from zteleop.cli import _options
from zteleop.cli._calibrating import find_out
from zteleop.cli._consent import ROOM_AHEAD, ask_consent
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


def run(arguments: argparse.Namespace) -> int:
    """Find out how far servo and motor turn, and write it down; 1 when whoever found out had enough."""
    file = SettingsFile(arguments.config)
    if arguments.to_donkeycar:
        export(file.settings, arguments.to_donkeycar, arguments.dry_run)
        return 0
    if arguments.from_donkeycar:
        keep(file, dict(imported(file.settings, arguments.from_donkeycar)), arguments.dry_run)
        return 0
    if arguments.meter is not None:
        keep(file, dict(measured(file.settings, arguments.meter)), arguments.dry_run)
        return 0
    settings = _options.with_typed(arguments, file.settings)
    if not settings.drive.mixer.takes_ticks:
        raise ConfigError(
            "calibrate knows cars, with steering and throttle, and this config makes none: "
            "write the pulses of its motors into [drive.servos] by hand"
        )
    robot = settings.robot or config.own_name()
    editor()
    open_terminal()  # what is missing is said before anything turns
    if settings.driver != "simulated":
        where = f"on the {settings.driver}, as far as the keys say"
        if arguments.trim:
            ask_consent(f"This drives the car {where}.", ROOM_AHEAD)
        else:
            ask_consent(f"This turns the steering and the motor {where}.")
    found = find_out(file, settings, robot, TRIM if arguments.trim else STEPS)
    if found is None:
        print(f"left before the end: {file.path} is as it was, and its neutral is written")
        return 1
    keep(file, of_servos(found), arguments.dry_run)
    return 0


def keep(file: SettingsFile, changes: Changes, dry_run: bool) -> None:
    """Write what was found out into the config file, or show what that would change."""
    text, after = file.changed(changes)
    if dry_run:
        print("\n".join(file.difference(text)) or f"{file.path} says so already")
        return
    there = bool(file.text)
    file.write(text)
    print("\n".join(pulses_told(file.settings, after)))
    before = f"; as it was before it is {file.backup}" if there else ", which is new"
    print(f"{file.path} is written{before}")
    if after.driver == "simulated":
        print('driver is "simulated": on the car, say driver = "pca9685"')
