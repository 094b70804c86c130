"""NXP PCA9685: sixteen 12-bit PWM channels behind I2C, as on the servo boards of Adafruit and Donkeycar."""

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Annotated

from msgspec import Meta, Struct

from zteleop.drivers.i2c import I2C, Block, open_i2c
from zteleop.drivers.lock import Lock, machine_folder
from zteleop.drivers.port import SMBUS_BLOCK, Port
from zteleop.drivers.registers import (
    ALL_LED_OFF_H,
    AUTO_INCREMENT,
    CHANNELS,
    FULL_OFF,
    MODE1,
    MODE2,
    OSCILLATOR_HZ,
    OUTDRV,
    PRE_SCALE,
    SLEEP,
    TICKS,
    led_blocks,
    led_runs,
    longest_us,
    prescale,
    read_duty_ticks,
    read_pulse_us,
    tick_us,
)
from zteleop.errors import ConfigError

__all__ = ["Pca9685", "Pca9685Settings", "prescale", "read_duty_ticks", "read_pulse_us", "tick_us"]

SETTLING = 0.005
"""s for the oscillator; the data sheet asks 500 us (section 7.3.1.1)."""


class Pca9685Settings(Struct, frozen=True, forbid_unknown_fields=True):
    bus: Annotated[int, Meta(ge=0)] = 1
    """The 1 of /dev/i2c-1."""
    address: Annotated[int, Meta(ge=0x40, le=0x7F)] = 0x40
    frequency_hz: Annotated[float, Meta(ge=24, le=1526)] = 60.0
    osc_hz: Annotated[float, Meta(ge=20e6, le=30e6)] = OSCILLATOR_HZ
    """25e6 x measured / computed frequency; boards differ by some 10 %."""
    arming: Annotated[float, Meta(ge=0, le=10)] = 2.0
    """s at neutral before the first command; most ESCs learn neutral in them."""
    oe_chip: str = "/dev/gpiochip0"
    """The GPIO chip whose line holds the OE pin."""
    oe_line: Annotated[int, Meta(ge=0)] | None = None
    """BCM number of the line on the OE pin; None where the pin is not wired."""

    def __post_init__(self) -> None:
        prescale(self.frequency_hz, self.osc_hz)


SETTINGS = Pca9685Settings


def count_us(settings: Pca9685Settings) -> float:
    """Return the length of one of the 4096 counts of a period, in us."""
    return tick_us(prescale(settings.frequency_hz, settings.osc_hz), settings.osc_hz)


class Pca9685:
    """Writes pulses; between writes, and after its process, the chip repeats the last ones for ever."""

    def __init__(
        self,
        i2c: I2C,
        settings: Pca9685Settings,
        sleep: Callable[[float], None] = time.sleep,
        what: str = "",
    ) -> None:
        self._port = Port(i2c, settings.address, what)
        self._osc_hz = settings.osc_hz
        self._sleep = sleep
        self._lock: Lock | None = None
        self._prescale = prescale(settings.frequency_hz, settings.osc_hz)
        self.tick_us = tick_us(self._prescale, settings.osc_hz)
        self.arming = settings.arming
        self._modes = {MODE1: AUTO_INCREMENT, MODE2: OUTDRV, PRE_SCALE: self._prescale}

    def claim(self, path: str) -> None:
        """Keep other drivers off the chip by a lock file.

        Raises DeviceError, with the bus released, naming the process that has the chip.
        """
        try:
            self._lock = Lock(path, self._port.what)
        except BaseException:
            self.close()
            raise

    def shared(self) -> list[int]:
        """Return the descriptors that a process must inherit to keep other drivers off as well."""
        file = self._lock.fileno() if self._lock else None
        return [] if file is None else [file]

    def start(self, neutral_us: Mapping[int, float]) -> None:
        """Bring the chip up with these channels at neutral, and read everything back.

        Raises DeviceError in words, ConfigError for a pulse that does not fit the period.
        """
        blocks = self._blocks(neutral_us)
        with self._port.in_words(search=True):
            bring_up = self._adopt if self._running() else self._initialise
            bring_up(blocks)
            self._port.verify(self._modes | _registers(blocks))

    def write(self, pulse_us: Mapping[int, float]) -> None:
        """Write every channel given in one transaction, which latches on its STOP.

        Raises DeviceError after three failures in a row, ConfigError for a pulse longer than the period.
        """
        blocks = self._blocks(pulse_us)
        with self._port.in_words():
            self._port.write(blocks)

    def read(self, channels: Iterable[int]) -> dict[int, float | None]:
        """Return the pulse widths in microseconds that leave the chip now; None where there are none."""
        channels, image = list(channels), bytearray(256)
        with self._port.in_words():
            for register in (MODE1, PRE_SCALE):
                image[register] = self._port.get(register)
            # without auto-increment a block would be one register again and again
            longest = SMBUS_BLOCK if image[MODE1] & AUTO_INCREMENT else 1
            for register, length in led_runs(channels, longest):
                image[register : register + length] = self._port.get_block(register, length)
        return {channel: read_pulse_us(image, channel, self._osc_hz) for channel in channels}

    def check(self) -> None:
        """Raise DeviceError when the chip forgot its settings; after a dip of its supply, writes succeed."""
        with self._port.in_words():
            self._port.verify(self._modes)

    def close(self) -> None:
        """Release the bus and the lock; the outputs stay as last written."""
        self._port.close()
        if self._lock:
            self._lock.release()

    def _running(self) -> bool:
        return not self._port.get(MODE1) & SLEEP and self._port.get(PRE_SCALE) == self._prescale

    def _adopt(self, blocks: Sequence[Block]) -> None:
        """Take over from a dead predecessor that left the chip driving: no gap in its pulses."""
        self._port.set(MODE1, AUTO_INCREMENT)
        self._port.write(blocks)
        if self._port.get(MODE2) != OUTDRV:
            self._port.set(MODE2, OUTDRV)

    def _initialise(self, blocks: Sequence[Block]) -> None:
        """Set the prescaler, which needs sleep, without cutting a pulse short (section 7.3.1.1)."""
        before = self._port.get(PRE_SCALE)
        self._port.set(ALL_LED_OFF_H, FULL_OFF)
        self._sleep(TICKS * tick_us(before, self._osc_hz) * 1e-6)
        self._port.set(MODE1, AUTO_INCREMENT | SLEEP)
        self._port.set(PRE_SCALE, self._prescale)
        self._port.set(MODE2, OUTDRV)
        self._port.set(MODE1, AUTO_INCREMENT)
        self._sleep(SETTLING)
        self._port.write(blocks)

    def _blocks(self, pulse_us: Mapping[int, float]) -> list[Block]:
        return led_blocks({channel: self._ticks(channel, width) for channel, width in pulse_us.items()})

    def _ticks(self, channel: int, width_us: float) -> int:
        ticks = width_us / self.tick_us
        fits = ticks > 0.5 and width_us < longest_us(self.tick_us)  # OFF must never equal ON, which is 0
        if channel not in CHANNELS or not fits:
            raise ConfigError(
                f"channel {channel}, {width_us:g} us: expected a channel of 0..15 and a pulse within the "
                f"period of {TICKS * self.tick_us:.0f} us; lower frequency_hz for a longer one"
            )
        return round(ticks)


def open_driver(settings: Pca9685Settings, *, exclusive: bool = True) -> Pca9685:
    """Open the chip at its address on a real bus.

    Raises DeviceError when the bus cannot be opened or another process drives the chip.
    """
    driver = Pca9685(open_i2c(settings.bus), settings)
    if exclusive:
        driver.claim(f"{machine_folder()}/zteleop-i2c-{settings.bus}-0x{settings.address:02x}.lock")
    return driver


def _registers(blocks: Sequence[Block]) -> dict[int, int]:
    return {first + offset: value for first, data in blocks for offset, value in enumerate(data)}
