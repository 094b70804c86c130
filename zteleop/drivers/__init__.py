"""Where pulses go. One file per driver, one line below."""

from collections.abc import Iterable, Mapping
from importlib import import_module
from typing import Any, Protocol

import msgspec

from zteleop.drivers.output_enable import OutputEnable, open_output_enable
from zteleop.errors import ConfigError, nearest


class PulseDriver(Protocol):
    """Something that repeats pulses on numbered channels until told otherwise.

    Every method raises DeviceError in words when the chip or its bus does not obey.
    """

    tick_us: float
    """Length of one of the 4096 counts of a period, as the chip really makes it."""

    arming: float
    """s that the ESC must see neutral before the first command."""

    def shared(self) -> list[int]:
        """Return the descriptors that a process must inherit to keep other drivers off as well."""

    def start(self, neutral_us: Mapping[int, float]) -> None:
        """Bring the chip up with these channels at neutral, and read them back."""

    def write(self, pulse_us: Mapping[int, float]) -> None:
        """Write every channel given, at once where the chip can, whatever they were before."""

    def read(self, channels: Iterable[int]) -> dict[int, float | None]:
        """Return the pulse widths in microseconds that leave the chip now; None where there are none."""

    def check(self) -> None:
        """Raise DeviceError when the chip forgot its settings, as it does when its supply dips."""

    def close(self) -> None:
        """Release the bus; the outputs stay as last written."""


DRIVERS = {
    "pca9685": "zteleop.drivers.pca9685",
    "simulated": "zteleop.drivers.simulated",
    "sysfs_pwm": "zteleop.drivers.sysfs_pwm",
}


def open_driver(
    name: str, settings: Mapping[str, object] | msgspec.Struct, *, exclusive: bool = True
) -> PulseDriver:
    """Open the driver of that name; `exclusive=False` is for the watchdog's hand alone.

    Raises ConfigError for an unknown name or setting, DeviceError when the chip is missing or taken.
    """
    checked = settings_of(name, settings)
    driver: PulseDriver = import_module(DRIVERS[name]).open_driver(checked, exclusive=exclusive)
    return driver


def settings_of(name: str, settings: Mapping[str, object] | msgspec.Struct) -> Any:
    """Return a driver's settings, checked; ConfigError for an unknown driver, name or value."""
    if name not in DRIVERS:
        raise ConfigError(f"no driver named {name!r}; {nearest(name, DRIVERS)}")
    try:
        return msgspec.convert(settings, settings_kind(name))
    except msgspec.ValidationError as error:
        from zteleop.text.mistakes import mistakes  # only where there are some

        found = mistakes(settings, settings_kind(name), path=("drivers", name))
        raise ConfigError("; ".join(f"{'.'.join(path)}: {words}" for path, words in found)) from error


def settings_kind(name: str) -> Any:
    """Return what the settings of a driver that is known are."""
    return import_module(DRIVERS[name]).SETTINGS


def tick_us(name: str, settings: Mapping[str, object]) -> float:
    """Return the length of a count, in microseconds, that a driver with these settings will have."""
    checked = settings_of(name, settings)
    counts: float = import_module(DRIVERS[name]).count_us(checked)
    return counts


def output_enable(name: str, settings: Mapping[str, object] | msgspec.Struct) -> OutputEnable | None:
    """Open the pin that lets a driver's pulses out, disabled at first; None where none is configured.

    Raises ConfigError for an unknown name or setting, DeviceError when the pin is missing or taken.
    """
    checked = settings_of(name, settings)
    line = getattr(checked, "oe_line", None)
    return None if line is None else open_output_enable(checked.oe_chip, line)
