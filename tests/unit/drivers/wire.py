"""A bus for tests."""

import errno
from collections.abc import Sequence

from zteleop.drivers.chip import Chip
from zteleop.drivers.i2c import Block
from zteleop.drivers.simulated import SimulatedI2C


class Wire(SimulatedI2C):
    """A bus that writes down every transfer, and fails when told to."""

    def __init__(self) -> None:
        chip = Chip(bytearray(256))
        chip.power_up()
        super().__init__(chip, "/dev/i2c-1")
        self.log: list[list[Block]] = []
        self.faults: list[int | tuple[int, int] | None] = []
        """For each transfer to come: None, an errno, or (errno, bytes that still get through)."""

        self.block_writes = 0
        """Transfers that were SMBus block writes, which every adapter can."""

        self.reads: list[tuple[int, int]] = []
        """The first register of each read, and how many."""

    def read_i2c_block_data(self, address: int, register: int, length: int) -> list[int]:
        assert length <= 32, "the kernel takes no more in one SMBus block"
        self.reads.append((register, length))
        return super().read_i2c_block_data(address, register, length)

    def write_i2c_block_data(self, address: int, register: int, data: Sequence[int]) -> None:
        assert len(data) <= 32, "the kernel takes no more in one SMBus block"
        self.block_writes += 1
        super().write_i2c_block_data(address, register, data)

    def transfer(self, address: int, blocks: Sequence[Block]) -> None:
        self.log.append([(register, bytes(data)) for register, data in blocks])
        fault = self.faults.pop(0) if self.faults else None
        if fault is None:
            return super().transfer(address, blocks)
        number, through = fault if isinstance(fault, tuple) else (fault, 0)
        self.chip.write([(blocks[0][0], blocks[0][1][:through])])
        raise OSError(number, errno.errorcode.get(number, "error"))
