"""A car as Donkeycar's `config.py` and `myconfig.py` tell it; such a file is read, and never run.

Names and what they mean: Donkeycar 5's `cfg_complete.py`, its older flat names, and `THROTTLE_RANGE`.
"""

import ast
import re
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from zteleop.errors import ConfigError, nearest

TRAIN, TABLE = "DRIVE_TRAIN_TYPE", "PWM_STEERING_THROTTLE"
TRAINS = (TABLE, "I2C_SERVO")
"""a servo and an ESC on a PCA9685; all others drive by other chips, or without one"""
FREQUENCY_HZ = 60.0
"""at which Donkeycar counts its pulses"""
PIN = re.compile(r"PCA9685\.(\d+):([0-9a-fA-F]+)\.(\d+)")
LAST_TICK = 4095


class Output(NamedTuple):
    """One channel; its pulses in counts of 4096 a period at 60 Hz, as they reach the wire."""

    channel: int | None
    """None where the file does not tell it"""
    least: float
    """full right, or full reverse"""
    neutral: float
    most: float
    """full left, or full forward"""


class Donkeycar(NamedTuple):
    """What of such a car a robot has to know."""

    steering: Output
    throttle: Output
    bus: int | None = None
    """of the chip; None where Donkeycar finds it by itself"""
    address: int | None = None


class Setting(NamedTuple):
    """What stands behind a name, and where; code where the value is not known without running it."""

    value: object
    where: str
    is_code: bool = False


def read(files: Iterable[tuple[str, str]]) -> Donkeycar:
    """Return the car that files, each a name and its text, tell; a later one goes before an earlier.

    Raises ConfigError, with file and line, for what is missing, is no number, would have to be run, or
    drives by something else than a servo and an ESC on a PCA9685.
    """
    settings: dict[str, Setting] = {}
    names = []
    for name, text in files:
        names.append(name)
        settings |= _settings(name, text)
    return _Reading(" and ".join(names), settings).car()


def written(car: Donkeycar) -> str:
    """Return the text of a `myconfig.py` for a car whose channels, bus and address are known."""
    chip = f"PCA9685.{car.bus}:{car.address:x}" if car.address is not None else ""
    return f'''\
# This car's calibration, written by `zteleop calibrate --to-donkeycar`.

{TRAIN} = "{TABLE}"
{TABLE} = {{
    "PWM_STEERING_PIN": "{chip}.{car.steering.channel}",
    "PWM_STEERING_SCALE": 1.0,
    "PWM_STEERING_INVERTED": False,
    "PWM_THROTTLE_PIN": "{chip}.{car.throttle.channel}",
    "PWM_THROTTLE_SCALE": 1.0,
    "PWM_THROTTLE_INVERTED": False,
    "STEERING_LEFT_PWM": {round(car.steering.most)},
    "STEERING_RIGHT_PWM": {round(car.steering.least)},
    "THROTTLE_FORWARD_PWM": {round(car.throttle.most)},
    "THROTTLE_STOPPED_PWM": {round(car.throttle.neutral)},
    "THROTTLE_REVERSE_PWM": {round(car.throttle.least)},
}}
'''


def _settings(name: str, text: str) -> dict[str, Setting]:
    """Return what each name of a file is bound to last."""
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        line = f":{error.lineno}" if isinstance(error, SyntaxError) and error.lineno else ""
        raise ConfigError(
            f"{name}{line}: expected a Donkeycar config in Python, found no Python: {error}"
        ) from None
    found: dict[str, Setting] = {}
    for statement in tree.body:
        where = f"{name}:{statement.lineno}"
        if bound := _assigned(statement):
            target, value = bound
            found[target] = _literal(value, where)
        else:
            found |= {changed: Setting(None, where, is_code=True) for changed in _touched(statement)}
    return found


def _assigned(statement: ast.stmt) -> tuple[str, ast.expr] | None:
    """Return the name and the value of a plain assignment."""
    match statement:
        case ast.Assign(targets=[ast.Name(id=name)], value=value):
            return name, value
        case ast.AnnAssign(target=ast.Name(id=name), value=ast.expr() as value):
            return name, value
    return None


def _literal(value: ast.expr, where: str) -> Setting:
    try:
        return Setting(ast.literal_eval(value), where)
    except (ValueError, TypeError, SyntaxError, MemoryError, RecursionError):
        return Setting(None, where, is_code=True)


def _touched(statement: ast.stmt) -> Iterable[str]:
    """Yield the names that a statement may bind or change in some other way."""
    for node in ast.walk(statement):
        match node:
            case ast.Name(id=name, ctx=ast.Store() | ast.Del()):
                yield name
            case ast.Subscript(value=ast.Name(id=name), ctx=ast.Store() | ast.Del()):
                yield name
            case ast.Call(func=ast.Attribute(value=ast.Name(id=name))):
                yield name
            case ast.alias(name=name, asname=other):
                yield other or name


class _Reading:
    """What is asked of the names of some files."""

    def __init__(self, files: str, settings: Mapping[str, Setting]) -> None:
        self._files = files
        self._settings = settings

    def car(self) -> Donkeycar:
        """Return the car, by the names of its drive train."""
        train = self._get(TRAIN)
        if train and train.value not in TRAINS:
            raise ConfigError(
                f"{train.where}: {TRAIN}: expected {' or '.join(TRAINS)}, a servo and an ESC on a PCA9685, "
                f"found {train.value!r}"
            )
        table = self._get(TABLE) if train is None or train.value == TABLE else None
        if table is None:
            return self._flat()
        if not isinstance(table.value, dict):
            raise ConfigError(f"{table.where}: {TABLE}: expected a table {{...}}, found {table.value!r}")
        inside = {str(name): Setting(value, table.where) for name, value in table.value.items()}
        return _Reading(f"{TABLE} of {self._files}", inside).nested()

    def nested(self) -> Donkeycar:
        """Return the car that a table tells."""
        chips = []
        channels = []
        for axis in ("STEERING", "THROTTLE"):
            bus, address, channel = self._pin(f"PWM_{axis}_PIN")
            chips.append((bus, address))
            channels.append(channel)
            if (inverted := self._get(f"PWM_{axis}_INVERTED")) and inverted.value:
                raise ConfigError(
                    f"{inverted.where}: PWM_{axis}_INVERTED: expected False, found {inverted.value!r}: "
                    "zteleop makes no inverted pulses"
                )
        if chips[0] != chips[1]:
            raise ConfigError(f"{self._files}: expected both pins on one chip, found two")
        scales = [self._number(f"PWM_{axis}_SCALE", 1.0, 0.1, 10) for axis in ("STEERING", "THROTTLE")]
        return Donkeycar(*self._outputs(channels, scales), *chips[0])

    def _flat(self) -> Donkeycar:
        channels = [self._whole(f"{axis}_CHANNEL", 0, 15) for axis in ("STEERING", "THROTTLE")]
        bus, address = self._whole("PCA9685_I2C_BUSNUM", 0, 255), self._whole("PCA9685_I2C_ADDR", 0x40, 0x7F)
        return Donkeycar(*self._outputs(channels, (1.0, 1.0)), bus, address)

    def _outputs(self, channels: Iterable[int | None], scales: Iterable[float]) -> tuple[Output, Output]:
        (steering, throttle), (steer, drive) = channels, scales
        if steering is not None and steering == throttle:
            raise ConfigError(f"{self._files}: steering and throttle are both on channel {steering}")
        left, right = self._ticks("STEERING_LEFT_PWM"), self._ticks("STEERING_RIGHT_PWM")
        stopped = self._ticks("THROTTLE_STOPPED_PWM")
        if self._get("THROTTLE_FORWARD_PWM") or self._get("THROTTLE_REVERSE_PWM"):
            forward, reverse = self._ticks("THROTTLE_FORWARD_PWM"), self._ticks("THROTTLE_REVERSE_PWM")
        else:
            reach = self._ticks("THROTTLE_RANGE")
            forward, reverse = stopped + reach, stopped - reach
        centre = round((left + right) / 2)
        return (
            Output(steering, right * steer, centre * steer, left * steer),
            Output(throttle, reverse * drive, stopped * drive, forward * drive),
        )

    def _get(self, name: str) -> Setting | None:
        """Return what a name is, None where it is not told; raises ConfigError for what is code."""
        found = self._settings.get(name)
        if found and found.is_code:
            raise ConfigError(
                f"{found.where}: {name}: expected a plain value, found code; "
                "zteleop reads such a file and never runs it: write the value there"
            )
        return found

    def _pin(self, name: str) -> tuple[int, int, int]:
        found = self._get(name)
        if found is None:
            raise ConfigError(f"{self._files}: expected {name}, found none; {self._near(name)}")
        if not (pin := PIN.fullmatch(str(found.value))) or int(pin[3]) > 15:
            raise ConfigError(
                f"{found.where}: {name}: expected a pin of a PCA9685 such as PCA9685.1:40.1, "
                f"found {found.value!r}"
            )
        return int(pin[1]), int(pin[2], 16), int(pin[3])

    def _ticks(self, name: str) -> float:
        if name not in self._settings:
            raise ConfigError(f"{self._files}: expected {name}, found none; {self._near(name)}")
        return self._number(name, 0.0, 1, LAST_TICK)

    def _whole(self, name: str, least: int, most: int) -> int | None:
        found = self._get(name)
        if found is None or found.value is None:
            return None
        return int(self._number(name, 0.0, least, most))

    def _number(self, name: str, default: float, least: float, most: float) -> float:
        found = self._get(name)
        if found is None:
            return default
        value = found.value
        if isinstance(value, bool) or not isinstance(value, int | float) or not least <= value <= most:
            raise ConfigError(
                f"{found.where}: {name}: expected a number between {least:g} and {most:g}, found {value!r}"
            )
        return value

    def _near(self, name: str) -> str:
        return nearest(name, (known for known in self._settings if known.isupper()))
