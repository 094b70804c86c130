"""A PCA9685 in a memory-mapped file, under the real driver: byte n of the file is register n.

Like the chip it outlives its drivers, keeps the last pulse of a killed one, and can be watched from outside.
`faults.Faults` lets its bus fail.
"""

import os
import time
from collections.abc import Sequence
from mmap import ACCESS_READ, ACCESS_WRITE
from typing import Annotated, Self

from msgspec import Meta, Struct

from zteleop.drivers.chip import SIZE, Chip
from zteleop.drivers.chip_file import FAULTS, ChipMemory, map_file
from zteleop.drivers.faults import Fault, cut, next_fault
from zteleop.drivers.i2c import EREMOTEIO, Block
from zteleop.drivers.pca9685 import Pca9685, Pca9685Settings
from zteleop.drivers.registers import OSCILLATOR_HZ, prescale, tick_us

LOOKS = 8


class SimulatedSettings(Struct, frozen=True, forbid_unknown_fields=True):
    path: str = ""
    """The file of registers; empty is `default_path()`."""
    frequency_hz: Annotated[float, Meta(ge=24, le=1526)] = 60.0
    osc_hz: Annotated[float, Meta(ge=20e6, le=30e6)] = OSCILLATOR_HZ
    arming: Annotated[float, Meta(ge=0, le=10)] = 0.0
    """s at neutral before the first command; a simulated ESC needs none."""

    def __post_init__(self) -> None:
        prescale(self.frequency_hz, self.osc_hz)


SETTINGS = SimulatedSettings


def count_us(settings: SimulatedSettings) -> float:
    """Return the length of one of the 4096 counts of a period, in us."""
    return tick_us(prescale(settings.frequency_hz, settings.osc_hz), settings.osc_hz)


class SimulatedI2C:
    """A bus with one chip on it; every write is one `transfer`, which is where faults can be put."""

    def __init__(self, chip: Chip, name: str, address: int = 0x40) -> None:
        self.name = name
        self.chip = chip
        self.address = address

    def transfer(self, address: int, blocks: Sequence[Block]) -> None:
        """Write all blocks in one transaction, or raise OSError with the kernel's errno."""
        chip = self._select(address)
        if _troubled(chip) and (fault := next_fault(self.name, sum(len(data) for _, data in blocks))):
            chip.write(cut(blocks, fault.after_bytes))
            _fail(fault)
        chip.write(blocks)

    def read_i2c_block_data(self, address: int, register: int, length: int) -> list[int]:
        chip = self._select(address)
        if _troubled(chip) and (fault := next_fault(self.name)):
            _fail(fault)
        return list(chip.read(register, length))

    def read_byte_data(self, address: int, register: int) -> int:
        return self.read_i2c_block_data(address, register, 1)[0]

    def write_byte_data(self, address: int, register: int, value: int) -> None:
        self.transfer(address, [(register, bytes((value,)))])

    def write_i2c_block_data(self, address: int, register: int, data: Sequence[int]) -> None:
        self.transfer(address, [(register, bytes(data))])

    def write_blocks(self, address: int, blocks: Sequence[Block]) -> None:
        self.transfer(address, blocks)

    def close(self) -> None:
        if isinstance(self.chip.memory, ChipMemory):
            self.chip.memory.close()

    def _select(self, address: int) -> Chip:
        """Return the chip at an address, for one transaction: its file is looked at once for all of it."""
        if address != self.address:
            raise OSError(EREMOTEIO, "nobody answers")
        memory = self.chip.memory
        return Chip(memory.present()) if isinstance(memory, ChipMemory) else self.chip


class Registers:
    """A chip's registers seen from outside: whoever holds this cannot write them."""

    def __init__(self, memory: ChipMemory) -> None:
        self._memory = memory

    def snapshot(self) -> bytes:
        """Return all 256 registers between two transactions."""
        seen = self._memory[:SIZE]
        for _ in range(LOOKS):  # the writer's copy takes nanoseconds: two equal looks are past it
            again = self._memory[:SIZE]
            if again == seen:
                break
            seen = again
        return seen

    def close(self) -> None:
        self._memory.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def open_driver(settings: SimulatedSettings, *, exclusive: bool = True) -> Pca9685:
    """Open the real driver on the simulated chip; switch the chip on if there is none.

    Raises DeviceError when the file cannot be opened or another process drives the chip.
    """
    path = settings.path or default_path()
    board = Pca9685Settings(
        frequency_hz=settings.frequency_hz, osc_hz=settings.osc_hz, arming=settings.arming
    )
    bus = SimulatedI2C(open_chip(path), path, board.address)
    driver = Pca9685(bus, board, what=f"the simulated chip {path}")
    if exclusive:
        driver.claim(f"{path}.lock")
    return driver


def open_chip(path: str) -> Chip:
    """Open the chip in that file to write it; switch it on if there is none.

    Raises DeviceError when the file cannot be opened.
    """
    return Chip(map_file(path, ACCESS_WRITE))


def open_registers(path: str = "") -> Registers:
    """Watch the chip in that file; switch it on if there is none, so that either side may start first.

    Raises DeviceError when the file cannot be opened.
    """
    return Registers(map_file(path or default_path(), ACCESS_READ))


def default_path(robot: str = "robot") -> str:
    """Return where a robot's simulated chip is, in the user's runtime folder."""
    folder = os.environ.get("XDG_RUNTIME_DIR") or f"/tmp/zteleop-{os.getuid()}"
    return f"{folder}/zteleop/{robot}.pca9685"


def _troubled(chip: Chip) -> bytes:
    return chip.memory[FAULTS].strip(b"\0")


def _fail(fault: Fault) -> None:
    time.sleep(fault.ms / 1000)
    raise OSError(fault.number, "a fault that was put in")
