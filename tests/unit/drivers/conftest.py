import errno

import pytest

from zteleop.drivers.chip import Chip
from zteleop.drivers.simulated import SimulatedI2C


class Wire(SimulatedI2C):
    """A bus that writes down every transfer, and fails when told to."""

    def __init__(self):
        chip = Chip(bytearray(256))
        chip.power_up()
        super().__init__(chip, "/dev/i2c-1")
        self.log = []
        self.faults = []
        """For each transfer to come: None, an errno, or (errno, bytes that still get through)."""

    def transfer(self, address, blocks):
        self.log.append([(register, bytes(data)) for register, data in blocks])
        fault = self.faults.pop(0) if self.faults else None
        if fault is None:
            return super().transfer(address, blocks)
        number, through = fault if isinstance(fault, tuple) else (fault, 0)
        self.chip.write([(blocks[0][0], blocks[0][1][:through])])
        raise OSError(number, errno.errorcode.get(number, "error"))


@pytest.fixture
def wire():
    return Wire()
