"""The contract, and what only a device file can do, through the real smbus2: run in a process that preloads.

python -m preload.device          says for each case in JSON what went wrong
"""

import json
import os
import sys
import traceback
from collections.abc import Callable
from random import Random
from typing import Any

import pytest
from smbus2 import SMBus, i2c_msg

from preload.contract import CASES, Bench, Case, fails, hold
from zteleop.drivers import PulseDriver, open_driver
from zteleop.drivers.faults import Faults
from zteleop.drivers.i2c import I2C, Block, open_i2c
from zteleop.drivers.registers import ALL_LED_ON_L, LED0_ON_L, MODE1, MODE2, PRE_SCALE
from zteleop.drivers.simulated import SimulatedI2C, open_chip, open_registers

SEED, TRANSACTIONS = 9685, 600
HOT = (MODE1, MODE1, MODE2, LED0_ON_L, LED0_ON_L + 7, 0x42, 0x45, ALL_LED_ON_L, ALL_LED_ON_L + 3, PRE_SCALE)
VALUES = {MODE1: (0x20, 0x20, 0x20, 0x30, 0x10, 0x00, 0xA0, 0xFF), PRE_SCALE: range(9)}


class DeviceBench(Bench):
    """The same chip through smbus2 and /dev/i2c-1."""

    def __init__(self, path: str) -> None:
        super().__init__(path)
        self.bus = "/dev/i2c-1"

    def i2c(self) -> I2C:
        return self._keep(open_i2c(1))

    def driver(self, **settings: Any) -> PulseDriver:
        return self._keep(open_driver("pca9685", settings, exclusive=False))


def a_bus_that_is_not_there_says_how_to_enable_it(bench: Bench) -> None:
    with fails(r"^/dev/i2c-7 not found; is I2C enabled\?"):
        bench.driver(bus=7)


def every_kind_of_smbus_transfer_reaches_the_chip(bench: Bench) -> None:
    with SMBus(1) as bus:
        bus.write_quick(0x40)
        bus.write_byte_data(0x40, MODE1, 0x20)
        assert bus.read_byte_data(0x40, MODE1) == 0x20
        bus.write_word_data(0x40, LED0_ON_L + 2, 0x0170)
        assert bus.read_word_data(0x40, LED0_ON_L + 2) == 0x0170
        bus.write_byte(0x40, LED0_ON_L + 2)
        assert [bus.read_byte(0x40), bus.read_byte(0x40)] == [0x70, 0x01]
        bus.write_i2c_block_data(0x40, LED0_ON_L, list(range(32)))
        assert bus.read_i2c_block_data(0x40, LED0_ON_L + 4, 4) == [4, 5, 6, 7]
        with pytest.raises(OSError, match="Operation not supported"):
            bus.write_block_data(0x40, LED0_ON_L, [1, 2])


def messages_of_one_transaction_share_a_stop(bench: Bench) -> None:
    """The third reads what the first has written; what came before one that finds nobody is latched."""
    with SMBus(1) as bus:
        bus.write_byte_data(0x40, MODE1, 0x20)
        read = i2c_msg.read(0x40, 2)
        point = i2c_msg.write(0x40, [LED0_ON_L + 2])
        bus.i2c_rdwr(i2c_msg.write(0x40, [LED0_ON_L, 0, 0, 0x70, 0x01]), point, read)
        assert bytes(read) == bytes([0x70, 0x01])
        write = i2c_msg.write(0x40, [LED0_ON_L, 0, 0, 0x71, 0x01])
        with pytest.raises(OSError, match="Remote I/O error"):
            bus.i2c_rdwr(write, i2c_msg.write(0x41, [0, 0]))
        assert bench.ticks(0) == [0x171]


def a_bus_that_is_closed_is_an_ordinary_file_again(bench: Bench) -> None:
    bus = SMBus(1)
    fd = bus.fd
    bus.close()
    again = os.open(os.devnull, os.O_RDWR)
    bus.fd, bus.address = again, None
    assert again == fd
    with pytest.raises(OSError, match="Inappropriate ioctl"):
        bus.read_byte_data(0x40, MODE1)
    os.close(again)


def both_models_of_the_chip_are_one(bench: Bench) -> None:
    """Random transactions, whole and torn, give the same answers, registers and faults to come."""
    random = Random(SEED)
    path = f"{bench.path}.other"
    real, simulated = bench.i2c(), SimulatedI2C(open_chip(path), path)
    with open_registers(path) as registers, Faults(path) as faults:
        for number in range(TRANSACTIONS):
            words, transaction = draw(random)
            put = draw_fault(random)
            for each in (bench.faults, faults):
                put(each)
            assert (outcome(real, transaction), bench.faults.pending(), bench.registers.snapshot()) == (
                outcome(simulated, transaction),
                faults.pending(),
                registers.snapshot(),
            ), f"transaction {number} of seed {SEED}: {words}"


def draw(random: Random) -> tuple[str, Callable[[I2C], Any]]:
    """Return a transaction, in words and to be done."""
    blocks = [draw_block(random, random.randint(1, 32))]
    [(register, data)] = blocks
    kind = random.choice(("get", "read", "set", "write", "write blocks"))
    if kind == "write blocks":
        blocks += [draw_block(random, random.randint(1, 9)) for _ in range(random.randrange(4))]
    transactions: dict[str, Callable[[I2C], Any]] = {
        "get": lambda i2c: i2c.read_byte_data(0x40, register),
        "read": lambda i2c: i2c.read_i2c_block_data(0x40, register, len(data)),
        "set": lambda i2c: i2c.write_byte_data(0x40, register, data[0]),
        "write": lambda i2c: i2c.write_i2c_block_data(0x40, register, list(data)),
        "write blocks": lambda i2c: i2c.write_blocks(0x40, blocks),
    }
    return f"{kind} {blocks}", transactions[kind]


def draw_block(random: Random, length: int) -> Block:
    register = random.choice((*HOT, *HOT, random.randrange(256)))
    return register, bytes((random.choice(VALUES.get(register, range(256))), *random.randbytes(length - 1)))


def draw_fault(random: Random) -> Callable[[Faults], object]:
    kind, number = random.randrange(20), random.randrange(12)
    puts: dict[int, Callable[[Faults], object]] = {
        0: lambda faults: faults.nack(1),
        1: lambda faults: faults.tear(2, number),
        2: lambda faults: faults.hang(1, 0),
        3: lambda faults: faults.brown_out(),
        4: lambda faults: faults.every(number % 4),
        5: lambda faults: faults.at_random(10 * (number % 6)),
    }
    return puts.get(kind, lambda faults: None)


def outcome(i2c: I2C, transaction: Callable[[I2C], Any]) -> Any:
    try:
        return transaction(i2c)
    except OSError as error:
        return f"errno {error.errno}"


DEVICE_CASES: list[Case] = [
    *CASES,
    a_bus_that_is_not_there_says_how_to_enable_it,
    every_kind_of_smbus_transfer_reaches_the_chip,
    messages_of_one_transaction_share_a_stop,
    a_bus_that_is_closed_is_an_ordinary_file_again,
    both_models_of_the_chip_are_one,
]


def run(case: Case, path: str) -> str | None:
    """Return what went wrong, if anything."""
    bench = DeviceBench(path)
    try:
        hold(case, bench)
    except (Exception, pytest.fail.Exception):
        return traceback.format_exc()
    finally:
        bench.close()
    return None


if __name__ == "__main__":
    path = os.environ["ZTELEOP_I2CDEV_FILE"]
    json.dump({case.__name__: run(case, path) for case in DEVICE_CASES}, sys.stdout)
