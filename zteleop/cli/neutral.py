import argparse
import sys
from pathlib import Path

from zteleop import config
from zteleop.bus.names import robot_name
from zteleop.cli import _options
from zteleop.cli._salvage import unknown_driver
from zteleop.config import Config
from zteleop.control.calibration import Calibration
from zteleop.drivers import DRIVERS, open_driver
from zteleop.errors import ConfigError, DeviceError, nearest

EXAMPLES = (
    "zteleop neutral",
    "zteleop neutral --robot archangel",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    _options.add_config(parser)
    parser.add_argument("--robot", metavar="NAME", help="whose simulated chip (default: this machine's own)")
    parser.add_argument("--driver", choices=DRIVERS, help="the chip to write to (default: simulated)")


def bring_to_rest(settings: Config, name: str, robot: str) -> Calibration:
    """Write neutral to the chip of that driver, whoever else writes to it; return what neutral is."""
    hand = open_driver(name, settings.driver_settings(name, robot), exclusive=False)
    calibration = Calibration(settings.drive.servos, hand.tick_us)
    try:
        hand.start(calibration.neutral_us)
    except DeviceError:
        # Bringing it up takes a dozen transfers, of which any may fail; this one counts.
        hand.write(calibration.neutral_us)
        raise
    finally:
        hand.close()
    return calibration


def _near(path: str) -> str:
    """Return whose chips lie beside one that is not there."""
    there = [file.stem for file in Path(path).parent.glob(f"*{Path(path).suffix}")]
    return f"; {nearest(Path(path).stem, there)}" if there and Path(path).suffix else ""


def run(arguments: argparse.Namespace) -> None:
    """Write neutral first and ask afterwards: it is never wrong."""
    settings, is_whole = _options.salvaged(arguments)
    if not arguments.driver and (said := unknown_driver(arguments.config)):
        raise ConfigError(
            f"nothing was written: which chip is meant by driver = {said!r}? {nearest(said, DRIVERS)}; "
            "say --driver NAME"
        )
    robot = robot_name(arguments.robot or settings.robot or config.own_name())
    name = arguments.driver or settings.driver
    chip = settings.driver_settings(name, robot)
    if name == "simulated" and not Path(chip["path"]).exists():
        raise DeviceError(
            f"nothing was written: {robot} has no simulated chip at {chip['path']}{_near(chip['path'])}; "
            "where it has one elsewhere, as a demo's, say --config FILE"
        )
    calibration = bring_to_rest(settings, name, robot)
    try:
        open_driver(name, chip).close()
    except DeviceError as error:
        raise DeviceError(f"neutral was written, but may not last: {error}") from error
    pulses = calibration.pulses(calibration.neutral_us)
    where = f"the simulated chip {chip['path']}" if name == "simulated" else f"the chip of {name}"
    print(
        f"{robot} at rest, in {where}: "
        + ", ".join(f"{p.name} {p.pulse_us:.0f} us = {p.duty_ticks} ticks" for p in pulses)
    )
    if not is_whole:
        words = "what of them is built in may not be this robot's: correct the file, and say it again"
        print(f"zteleop neutral: warning: {words}", file=sys.stderr)
