"""A robot's chip, seen from outside: the only witness of whether its wheels turn."""

from collections.abc import Callable, Mapping
from contextlib import suppress

from zteleop.config import Config
from zteleop.control.calibration import Calibration
from zteleop.drivers import PulseDriver, open_driver, registers, settings_of, tick_us
from zteleop.drivers.simulated import open_registers
from zteleop.errors import DeviceError

Pulses = Mapping[int, float | None]
"""Microseconds by channel; None where no pulse leaves the chip."""


class Eye:
    """Sees which pulses leave the chip, and whether they are those of rest."""

    def __init__(
        self, read: Callable[[], Pulses], calibration: Calibration, close: Callable[[], object]
    ) -> None:
        self.pulses = read
        self.calibration = calibration
        self.close = close

    @property
    def at_rest(self) -> bool:
        return self.calibration.at_rest(self.pulses())


def open_eye(settings: Config, robot: str, chip: str) -> Eye:
    """Look at a simulated chip in its file, which costs the robot nothing; without one at the real chip."""
    values = settings.driver_settings(settings.driver, robot)
    checked = settings_of(settings.driver, values)
    calibration = Calibration(settings.drive.servos, tick_us(settings.driver, values))
    channels = list(calibration.neutral_us)
    if not chip:
        driver = open_driver(settings.driver, values, exclusive=False)
        return Eye(_on_wire(driver, channels), calibration, driver.close)
    memory = open_registers(chip)

    def read() -> Pulses:
        image = memory.snapshot()
        return {channel: registers.read_pulse_us(image, channel, checked.osc_hz) for channel in channels}

    return Eye(read, calibration, memory.close)


def _on_wire(driver: PulseDriver, channels: list[int]) -> Callable[[], Pulses]:
    seen: Pulses = dict.fromkeys(channels)

    def read() -> Pulses:
        nonlocal seen
        with suppress(DeviceError):  # a bus that is disturbed: what was seen last still leaves the chip
            seen = driver.read(channels)
        return seen

    return read
