"""One chip's registers through its bus: retried where that is right, checked, and failing in words."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import TypeVar

from zteleop.drivers.i2c import I2C, NOBODY, Block, answering, failure
from zteleop.drivers.registers import MODE1, RESTART, register_name
from zteleop.errors import DeviceError

SMBUS_BLOCK = 32
ATTEMPTS = 3
TRIED_FOR = 0.05
"""s; a transfer that takes so long to fail is not tried again: others wait for whoever waits for it"""
T = TypeVar("T")


class Port:
    """The registers at one address of a bus; transfers raise OSError, `in_words` makes it a DeviceError."""

    def __init__(self, i2c: I2C, address: int, what: str = "") -> None:
        self._i2c = i2c
        self._address = address
        self._found: str | None = None
        self.what = what or f"the PCA9685 at 0x{address:02x} on {i2c.name}"
        self.close = i2c.close

    @contextmanager
    def in_words(self, search: bool = False) -> Iterator[None]:
        """Turn OSError into DeviceError; with `search`, a missing chip's sentence says who does answer.

        The bus is searched once, until all goes well: that is 64 transfers, to other people's chips too.
        """
        try:
            yield
            self._found = self._found if not search else None
        except DeviceError:
            raise
        except OSError as error:
            nobody = search and error.errno in NOBODY
            if nobody and self._found is None:
                self._found = answering(self._i2c, self._address)
            found = self._found or "" if nobody else ""
            raise failure(error, self._i2c.name, self._address, found) from error

    def get(self, register: int) -> int:
        """Return one register."""
        return again(lambda: self._i2c.read_byte_data(self._address, register))

    def set(self, register: int, value: int) -> None:
        """Write one register."""
        again(lambda: self._i2c.write_byte_data(self._address, register, value))

    def get_block(self, register: int, length: int) -> bytes:
        """Return up to 32 registers from `register` on."""
        return bytes(again(lambda: self._i2c.read_i2c_block_data(self._address, register, length)))

    def write(self, blocks: Sequence[Block]) -> None:
        """Write all blocks in one transaction, and after an error all of them again.

        A torn transfer ends in a STOP too, which latches half of it.
        """
        again(lambda: self._transact(blocks))

    def verify(self, wanted: Mapping[int, int]) -> None:
        """Raise DeviceError naming the registers that do not hold what was written."""
        found = {register: self.get(register) for register in wanted}
        found[MODE1] &= ~RESTART
        wrong = [
            f"{register_name(register)} reads 0x{found[register]:02x}, not 0x{value:02x}"
            for register, value in wanted.items()
            if found[register] != value
        ]
        if wrong:
            raise DeviceError(
                f"{self.what} does not hold what was written ({', '.join(wrong)}); "
                "check its supply, and that nothing else writes to it"
            )

    def _transact(self, blocks: Sequence[Block]) -> None:
        if len(blocks) == 1 and len(blocks[0][1]) <= SMBUS_BLOCK:
            register, data = blocks[0]
            self._i2c.write_i2c_block_data(self._address, register, list(data))
        elif blocks:
            self._i2c.write_blocks(self._address, blocks)


def again(transfer: Callable[[], T]) -> T:
    """Do a transfer, and after an error at once again: twice at most, and not on a slow bus."""
    began = time.monotonic()
    for attempt in range(1, ATTEMPTS + 1):
        try:
            return transfer()
        except OSError:
            if attempt == ATTEMPTS or time.monotonic() - began > TRIED_FOR:
                raise
    raise AssertionError
