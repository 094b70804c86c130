"""The one place that touches smbus2, and every way an I2C bus fails, in words."""

import errno
import sys
from collections.abc import Sequence
from typing import Any, Protocol

from zteleop.errors import DeviceError

Block = tuple[int, bytes]
"""The first register and what goes into it and those after."""

I2C_TIMEOUT = 0x0702  # <linux/i2c-dev.h>; units of 10 ms
SMBUS_WRITE_I2C_BLOCK = 0x08000000  # <linux/i2c.h>
EREMOTEIO = 121  # Linux's number: elsewhere `errno` has no such name
NOBODY = (errno.ENXIO, EREMOTEIO)
TIMEOUT_MS = 20


class I2C(Protocol):
    """The part of smbus2.SMBus that zteleop uses, and one transaction of several blocks.

    Methods raise OSError with the kernel's errno.
    """

    name: str
    """What people call this bus, such as /dev/i2c-1."""

    def read_byte_data(self, address: int, register: int) -> int: ...
    def read_i2c_block_data(self, address: int, register: int, length: int) -> list[int]: ...
    def write_byte_data(self, address: int, register: int, value: int) -> None: ...
    def write_i2c_block_data(self, address: int, register: int, data: Sequence[int]) -> None: ...
    def write_blocks(self, address: int, blocks: Sequence[Block]) -> None:
        """Write all blocks in one transaction: repeated START between them, one STOP."""

    def close(self) -> None: ...


class LinuxI2C:
    """`/dev/i2c-<bus>` through smbus2."""

    def __init__(self, adapter: Any, message: Any, name: str) -> None:
        self.name = name
        self._adapter = adapter
        self._message = message
        self.read_byte_data = adapter.read_byte_data
        self.read_i2c_block_data = adapter.read_i2c_block_data
        self.write_byte_data = adapter.write_byte_data
        self.write_i2c_block_data = adapter.write_i2c_block_data
        self.close = adapter.close

    def write_blocks(self, address: int, blocks: Sequence[Block]) -> None:
        """Write all blocks in one transaction."""
        self._adapter.i2c_rdwr(
            *(self._message(address, bytes((register,)) + data) for register, data in blocks)
        )


def open_i2c(bus: int, smbus2: Any = None, ioctl: Any = None) -> I2C:
    """Open `/dev/i2c-<bus>` with a timeout of 20 ms; tests bring their own smbus2 and ioctl.

    Raises DeviceError when the bus is missing, forbidden or cannot write blocks.
    """
    try:
        if smbus2 is None:
            import smbus2  # needs Linux, so not at import time
        if ioctl is None:
            from fcntl import ioctl
    except ImportError as error:
        here = "pip install smbus2" if sys.platform == "linux" else f"this is {sys.platform}"
        raise DeviceError(f"I2C needs Linux and smbus2 ({here}); or use the simulated driver") from error
    adapter = smbus2.SMBus()
    try:
        _prepare(adapter, bus, ioctl)
    except OSError as error:
        adapter.close()
        raise failure(error, f"/dev/i2c-{bus}") from error
    return LinuxI2C(adapter, smbus2.i2c_msg.write, f"/dev/i2c-{bus}")


def _prepare(adapter: Any, bus: int, ioctl: Any) -> None:
    adapter.open(bus)
    if not adapter.funcs & SMBUS_WRITE_I2C_BLOCK:
        raise OSError(errno.EOPNOTSUPP, "no I2C block writes")
    ioctl(adapter.fd, I2C_TIMEOUT, TIMEOUT_MS // 10)  # the kernel's own is a second: 50 steps of the car


def failure(error: OSError, name: str, address: int | None = None, found: str = "") -> DeviceError:
    """Return a failed transfer as one sentence: where, what is wrong, what to do next."""
    number = name.removeprefix("/dev/i2c-")
    at = name if address is None else f"0x{address:02x} on {name}"
    kernel = f"/sys/bus/i2c/devices/{number}-{address or 0:04x}/driver"
    nobody = f"nobody answers at {at}; {found or 'check power and wiring'} (i2cdetect -y {number})"
    sentences = {
        errno.ENOENT: f"{name} not found; is I2C enabled? (sudo raspi-config nonint do_i2c 0)",
        errno.EACCES: f"{name}: no permission; add yourself to group i2c (sudo usermod -aG i2c $USER) "
        "and log in again",
        errno.EBUSY: f"{at} is taken by a kernel driver (ls -l {kernel}); remove its dtoverlay and reboot",
        errno.ENXIO: nobody,
        EREMOTEIO: nobody,
        errno.ETIMEDOUT: f"{at}: no transfer within {TIMEOUT_MS} ms, something holds SDA or SCL low; "
        "check the wiring and power-cycle the chip",
        errno.EOPNOTSUPP: f"{at}: the adapter cannot write such I2C blocks (i2cdetect -F {number}); "
        "use adjacent channels or another bus",
        errno.ENODEV: f"{at}: the adapter is gone; plug it in again",
    }
    otherwise = f"{at}: {error.strerror or error}; check power, wiring and the length of the cable"
    return DeviceError(sentences.get(error.errno or 0, otherwise))


ALL_CALL = 0x70
"""Where every PCA9685 answers as well, until it is told not to (section 7.3.7)."""


def answering(i2c: I2C, wanted: int) -> str:
    """Say which addresses answer where a PCA9685 may live, 0x40..0x7f."""
    found = [address for address in range(0x40, 0x80) if _answers(i2c, address)]
    if wanted in found:
        return "it did when asked again: check for a loose wire"
    if not found:
        return "nor at any other; check power and wiring"
    there = ", ".join(f"0x{address:02x}" for address in found)
    likely = next((address for address in found if address != ALL_CALL), found[0])
    return f"found {there}; if that is the chip, set address = 0x{likely:02x}"


def _answers(i2c: I2C, address: int) -> bool:
    try:
        i2c.read_byte_data(address, 0)
    except OSError as error:
        return error.errno == errno.EBUSY
    return True
