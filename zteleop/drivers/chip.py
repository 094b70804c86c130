"""The PCA9685 as its bus sees it, on the first 256 bytes of memory, which change once a transaction.

Data sheet rev. 4, section 7.3; what a servo sees of it is `registers.read_pulse_us`.
"""

from collections.abc import Iterable, Iterator
from typing import Protocol

from zteleop.drivers.i2c import EREMOTEIO, Block
from zteleop.drivers.registers import (
    ALL_LED_ON_L,
    AUTO_INCREMENT,
    CHANNELS,
    EXTCLK,
    FULL_OFF,
    LED0_ON_L,
    LED15_OFF_H,
    MODE1,
    MODE2,
    PRE_SCALE,
    RESTART,
    SLEEP,
)

SIZE = 256
LEDS = range(LED0_ON_L, LED15_OFF_H + 1)
ALL_LEDS = range(ALL_LED_ON_L, PRE_SCALE)
POWER_UP = b"".join(
    (
        b"\x11\x04\xe2\xe4\xe8\xe0",  # MODE1, MODE2, SUBADR1..3, ALLCALLADR
        bytes((0, 0, 0, FULL_OFF)) * len(CHANNELS),
        bytes(PRE_SCALE - LED15_OFF_H - 1),
        b"\x1e\x00",  # PRE_SCALE, TestMode
    )
)


class Memory(Protocol):
    """Bytes that can be read and changed in slices."""

    def __getitem__(self, place: slice, /) -> bytes: ...

    def __setitem__(self, place: slice, data: bytes, /) -> None: ...


class Chip:
    """Answers transactions; `memory` holds the registers and is shared with whoever watches."""

    def __init__(self, memory: Memory) -> None:
        self.memory = memory

    def power_up(self) -> None:
        """Forget everything, as when the supply dips."""
        self.memory[:SIZE] = POWER_UP

    def read(self, register: int, length: int) -> bytes:
        """Return `length` bytes from `register` on; ALL_LED_* hold nothing and read 0."""
        image = self.memory[:SIZE]
        return bytes(image[place] for place in _places(image, register, length))

    def write(self, blocks: Iterable[Block]) -> None:
        """Take one transaction, (register, bytes) for each START of it, and latch at the STOP.

        Raises OSError(EREMOTEIO) at a reserved register, after latching what came before it.
        """
        image = bytearray(self.memory[:SIZE])
        try:
            for register, data in blocks:
                for value, place in zip(data, _places(image, register, len(data)), strict=True):
                    _store(image, place, value)
        finally:
            self._latch(image)

    def _latch(self, image: bytearray) -> None:
        """Show a transaction in one piece of memory, so that a reader does not see half of it."""
        changed = int.from_bytes(self.memory[:SIZE], "little") ^ int.from_bytes(image, "little")
        if changed:
            first, end = (changed & -changed).bit_length() - 1 >> 3, changed.bit_length() + 7 >> 3
            self.memory[first:end] = bytes(image[first:end])


def _places(image: bytes | bytearray, register: int, length: int) -> Iterator[int]:
    """Yield where each byte goes: one register for all of them unless MODE1.AI is set by then."""
    for _ in range(length):
        if register in range(LED15_OFF_H + 1, ALL_LED_ON_L) or register > PRE_SCALE:
            raise OSError(EREMOTEIO, f"register 0x{register:02x} is reserved")
        yield register
        if image[MODE1] & AUTO_INCREMENT:
            register = 0 if register in (LED15_OFF_H, PRE_SCALE) else register + 1


def _store(image: bytearray, place: int, value: int) -> None:
    if place == MODE1:
        image[MODE1] = _mode1(image, value)
    elif place == MODE2:
        image[MODE2] = value & 0x1F
    elif place == PRE_SCALE:
        _prescale(image, value)
    elif place in ALL_LEDS:
        _led(image, range(LED0_ON_L + place - ALL_LED_ON_L, LED15_OFF_H + 1, 4), value)
    elif place in LEDS:
        _led(image, range(place, place + 1), value)
    else:
        image[place] = value & 0xFE  # SUBADR1..3 and ALLCALLADR


def _mode1(image: bytearray, value: int) -> int:
    """Return the new MODE1: EXTCLK never clears, RESTART is set by a sleep that cuts pulses."""
    before = image[MODE1]
    restart = before & RESTART
    if value & SLEEP and not before & SLEEP and _driving(image):
        restart = RESTART
    elif value & RESTART and not value & SLEEP:
        restart = 0
    return value & ~RESTART | restart | before & EXTCLK


def _driving(image: bytearray) -> bool:
    return any(not image[LED0_ON_L + 4 * channel + 3] & FULL_OFF for channel in CHANNELS)


def _prescale(image: bytearray, value: int) -> None:
    if image[MODE1] & SLEEP:  # awake it is ignored, without an error
        image[PRE_SCALE] = max(3, value)


def _led(image: bytearray, places: range, value: int) -> None:
    high = (places[0] - LED0_ON_L) % 2
    for place in places:
        image[place] = value & (0x1F if high else 0xFF)
    image[MODE1] &= ~RESTART  # with MODE2.OCH 0, any PWM register and a STOP restart the outputs
