import argparse
from collections.abc import Iterator
from pathlib import Path

import msgspec

from zteleop import config
from zteleop.cli.up import programs_of
from zteleop.config import Config
from zteleop.control.calibration import check_pulses
from zteleop.control.report import to_vehicle
from zteleop.drivers import DRIVERS, settings_of
from zteleop.drivers.registers import longest_us
from zteleop.text.paths import leaves

EXAMPLES = (
    "zteleop check",
    "zteleop check config.toml",
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("file", nargs="?", type=Path, help="default: what every verb would read")
    parser.add_argument("--config", metavar="FILE", type=Path, help=argparse.SUPPRESS)


def run(arguments: argparse.Namespace) -> None:
    path = arguments.file or arguments.config
    settings = config.load(path)
    check_pulses(settings.drive.servos, longest_us(settings.tick_us))
    path = path or config.found()
    if path:
        programs_of(settings.launch, path)
    what = path or "no config file: the built-in simulated car"
    print(f"{what}: good\n{_summary(settings)}")


def _summary(settings: Config) -> str:
    """Say in a few lines what a robot with these settings is."""
    vehicle = to_vehicle(settings.drive, settings.tick_us)
    lines = [
        f"robot    {settings.robot or 'a name of its own'}",
        f"driver   {settings.driver}",
        f"vehicle  {vehicle.kind}, at most {vehicle.max_speed:g} m/s and {vehicle.max_turn:.2g} rad/s",
    ]
    for c in vehicle.channels:
        widths = f"{c.min_us:.0f} {c.neutral_us:.0f} {c.max_us:.0f} us"
        lines.append(
            f"{c.name:8} channel {c.channel}: {widths} = {c.min_ticks} {c.neutral_ticks} {c.max_ticks} ticks"
        )
    sources = sorted(settings.drive.known_sources.items(), key=lambda item: -item[1].priority)
    lines.append("sources  " + ", ".join(f"{name} {source.priority}" for name, source in sources))
    lines += _idle_limits(settings)
    for name, ours, theirs in _changes(settings):
        built_in = f", built in {_shown(theirs)}" if theirs is not None else ""
        lines.append(f"set      {name} = {_shown(ours)}{built_in}")
    return "\n".join(lines)


def _shown(value: object) -> object:
    """Return a value as the file spells it, but for the quotes."""
    return str(value).lower() if isinstance(value, bool) else value


def _idle_limits(settings: Config) -> Iterator[str]:
    """Yield the limits that bound nothing, as the vehicle makes no more anyway."""
    limits, mixer = settings.drive.limits, settings.drive.mixer
    own = msgspec.structs.replace(limits, speed=None, turn=None).in_numbers(mixer)
    for name, unit in (("speed", "m/s"), ("turn", "rad/s")):
        asked, most = getattr(limits, name), getattr(own, name)
        if asked is not None and asked > most:
            yield f"note     limits.{name} = {asked:g} bounds nothing: the vehicle makes {most:.3g} {unit}"


def _changes(settings: Config) -> Iterator[tuple[str, object, object]]:
    """Yield each setting that is not what is built in: its name, what it is, what it would be."""
    ours, theirs = (
        {name: value for name, value in leaves(_all(each)) if value not in (None, {}, [])}
        for each in (settings, Config())
    )
    for name in sorted(ours.keys() | theirs.keys()):
        if ours.get(name) != theirs.get(name):
            yield name, ours.get(name, "nothing"), theirs.get(name)


def _all(settings: Config) -> dict[str, object]:
    """Return every setting, also those of drivers that are not said."""
    drivers = {name: settings_of(name, settings.drivers.get(name, {})) for name in DRIVERS}
    values: dict[str, object] = msgspec.to_builtins(settings)
    return values | {"drivers": msgspec.to_builtins(drivers)}
