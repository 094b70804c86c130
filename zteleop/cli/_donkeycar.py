"""A config file from a Donkeycar's, and back."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from msgspec.structs import replace

from zteleop.cli._settings_file import PULSES, of_servos
from zteleop.cli._text import read_text
from zteleop.config import Config
from zteleop.control.servo import Servo
from zteleop.drivers.pca9685 import Pca9685Settings
from zteleop.drivers.registers import prescale, tick_us
from zteleop.errors import ConfigError
from zteleop.text import donkeycar
from zteleop.text.donkeycar import Donkeycar, Output

DONKEY_TICK_US = tick_us(prescale(donkeycar.FREQUENCY_HZ))
"""of its chip, as its driver sets it"""


def export(settings: Config, path: Path, dry_run: bool) -> None:
    """Write a Donkeycar file; raises ConfigError for a vehicle that is none, and a file that is there."""
    servos = settings.drive.servos
    if not {"steering", "throttle"} <= servos.keys():
        raise ConfigError(
            f"Donkeycar knows cars with steering and throttle; this one has {', '.join(sorted(servos))}"
        )
    chip = chip_of(settings)
    car = Donkeycar(in_counts(servos["steering"]), in_counts(servos["throttle"]), chip.bus, chip.address)
    text = donkeycar.written(car)
    if dry_run:
        print(text, end="")
        return
    try:
        with path.open("x", encoding="utf-8") as out:
            out.write(text)
    except FileExistsError:
        raise ConfigError(f"{path} is there already, and stays; say another name, or --dry-run") from None
    except OSError as error:
        raise ConfigError(f"cannot write {path}: {error.strerror}") from None
    print(f"{path} is written: put it beside your Donkeycar's config.py, as myconfig.py")


def in_counts(servo: Servo) -> Output:
    """Return a servo in Donkeycar's counts."""
    return Output(servo.channel, *(getattr(servo, field) / DONKEY_TICK_US for field in PULSES))


def imported(settings: Config, path: Path) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield what a Donkeycar file changes in settings."""
    files = donkey_files(path)
    car, where = donkeycar.read((str(file), read_text(file)) for file in files), " and ".join(map(str, files))
    servos = settings.drive.servos
    if not {"steering", "throttle"} <= servos.keys():
        raise ConfigError(
            f"a Donkeycar has steering and throttle; this vehicle has {', '.join(sorted(servos))}"
        )
    taken_over = {"throttle": car.throttle, "steering": car.steering}
    yield from of_servos(
        {name: taken(servos[name], pulses, where) for name, pulses in taken_over.items()}
    ).items()
    chip = chip_of(settings)
    for name, value in (("bus", car.bus), ("address", car.address)):
        if value not in (None, getattr(chip, name)):
            yield ("drivers", "pca9685", name), value


def chip_of(settings: Config) -> Pca9685Settings:
    """Return the settings of the chip that a Donkeycar has."""
    return Pca9685Settings(**settings.drivers.get("pca9685", {}))


def taken(servo: Servo, output: Output, where: str) -> Servo:
    """Return a servo with the pulses of a Donkeycar."""
    channel = servo.channel if output.channel is None else output.channel
    least, neutral, most = (ticks * DONKEY_TICK_US for ticks in output[1:])
    try:
        return replace(servo, channel=channel, min_us=least, neutral_us=neutral, max_us=most)
    except ValueError as error:
        raise ConfigError(
            f"{where}: pulses {output.least:g} {output.neutral:g} {output.most:g} ticks: {error}"
        ) from None


def donkey_files(path: Path) -> list[Path]:
    """Return the file meant, and the myconfig.py beside a config.py, which Donkeycar reads after it."""
    if path.is_dir():
        path = path / "config.py"
    beside = path.with_name("myconfig.py")
    return [path, beside] if path.name == "config.py" and beside.exists() else [path]
