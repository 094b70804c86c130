import errno
import os
import re
import sys
from types import SimpleNamespace
from typing import Any, Self

import pytest
import smbus2 as real_smbus2
from unit.drivers.wire import Wire

from zteleop.drivers.i2c import ALL_CALL, answering, failure, open_i2c
from zteleop.drivers.pca9685 import Pca9685, Pca9685Settings
from zteleop.errors import DeviceError


class FakeSmbus2:
    """Stands for the module and for its SMBus at once."""

    fd = 7
    funcs = 0x08000001

    def __init__(self, error: int | None = None) -> None:
        self.error, self.closed = error, False
        self.sent: list[Any] = []
        self.i2c_msg = SimpleNamespace(write=lambda address, data: (address, bytes(data)))
        self.read_byte_data = self.read_i2c_block_data = None
        self.write_byte_data = self.write_i2c_block_data = None

    def SMBus(self) -> Self:  # noqa: N802
        return self

    def open(self, bus: int) -> None:
        self.bus = bus
        if self.error:
            raise OSError(self.error, os.strerror(self.error))

    def i2c_rdwr(self, *messages: Any) -> None:
        self.sent.append(messages)

    def close(self) -> None:
        self.closed = True


def test_the_adapters_timeout_is_20_ms() -> None:
    calls = []
    fake = FakeSmbus2()
    i2c = open_i2c(3, fake, lambda *call: calls.append(call))
    assert calls == [(7, 0x0702, 2)]
    assert (fake.bus, i2c.name) == (3, "/dev/i2c-3")
    i2c.close()
    assert fake.closed


def test_blocks_go_out_as_messages_of_one_transaction() -> None:
    fake = FakeSmbus2()
    i2c = open_i2c(1, fake, lambda *_: None)
    i2c.write_blocks(0x40, [(0x06, b"\0\0\1\2"), (0x16, b"\0\0\3\4")])
    assert fake.sent == [((0x40, b"\x06\0\0\1\2"), (0x40, b"\x16\0\0\3\4"))]


@pytest.mark.parametrize(
    ("error", "sentence"),
    [
        (errno.ENOENT, "/dev/i2c-1 not found; is I2C enabled? (sudo raspi-config nonint do_i2c 0)"),
        (
            errno.EACCES,
            "/dev/i2c-1: no permission; add yourself to group i2c (sudo usermod -aG i2c $USER) "
            "and log in again",
        ),
        (errno.EIO, "/dev/i2c-1: Input/output error; check power, wiring and the length of the cable"),
    ],
)
def test_a_bus_that_does_not_open_says_why_and_is_closed(error: int, sentence: str) -> None:
    fake = FakeSmbus2(error)
    with pytest.raises(DeviceError, match=f"^{re.escape(sentence)}$"):
        open_i2c(1, fake, lambda *_: None)
    assert fake.closed


def test_an_adapter_without_block_writes_is_refused() -> None:
    fake = FakeSmbus2()
    fake.funcs = 0x06FF0009 & ~0x08000000
    with pytest.raises(DeviceError, match="cannot write such I2C blocks"):
        open_i2c(1, fake, lambda *_: None)
    assert fake.closed


def test_without_smbus2_it_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "smbus2", None)
    with pytest.raises(DeviceError, match=r"needs Linux and smbus2 .*; or use the simulated driver"):
        open_i2c(1)


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (errno.ENXIO, "nobody answers at 0x40 on /dev/i2c-1; check power and wiring (i2cdetect -y 1)"),
        (errno.EREMOTEIO, "nobody answers at 0x40 on /dev/i2c-1; check power and wiring (i2cdetect -y 1)"),
        (
            errno.EBUSY,
            "0x40 on /dev/i2c-1 is taken by a kernel driver (ls -l /sys/bus/i2c/devices/1-0040/driver)",
        ),
        (errno.ETIMEDOUT, "0x40 on /dev/i2c-1: no transfer within 20 ms, something holds SDA or SCL low"),
        (errno.EOPNOTSUPP, "use adjacent channels or another bus"),
        (errno.ENODEV, "0x40 on /dev/i2c-1: the adapter is gone; plug it in again"),
        (errno.EAGAIN, "0x40 on /dev/i2c-1: "),
    ],
)
def test_a_failed_transfer_says_where_what_and_what_to_do(error: int, words: str) -> None:
    sentence = str(failure(OSError(error, os.strerror(error)), "/dev/i2c-1", 0x40))
    assert words in sentence
    assert ";" in sentence


def test_answering_names_the_addresses_that_do(wire: Wire) -> None:
    wire.address = 0x70
    assert answering(wire, 0x40) == "found 0x70; if that is the chip, set address = 0x70"
    assert answering(wire, 0x70) == "it did when asked again: check for a loose wire"
    wire.address = 0x20
    assert answering(wire, 0x40) == "nor at any other; check power and wiring"


def test_of_a_chip_that_answers_to_all_calls_too_its_own_address_is_advised() -> None:
    class Bus:
        def read_byte_data(self, address: int, register: int) -> int:
            if address not in (ALL_CALL, 0x7F):
                raise OSError(errno.ENXIO, "nobody")
            return 0

    assert answering(Bus(), 0x40) == "found 0x70, 0x7f; if that is the chip, set address = 0x7f"


def test_the_real_smbus2_speaks_to_the_chip(wire: Wire, monkeypatch: pytest.MonkeyPatch) -> None:
    """Everything but the kernel: smbus2's own ioctls, answered by the simulated chip."""
    module = real_smbus2.smbus2
    opened = SimpleNamespace(O_RDWR=os.O_RDWR, open=lambda *_: os.open(os.devnull, os.O_RDWR), close=os.close)
    monkeypatch.setattr(module, "os", opened)
    monkeypatch.setattr(module, "ioctl", kernel(wire, module))
    driver = Pca9685(open_i2c(1, ioctl=lambda *_: None), Pca9685Settings(), lambda _: None)
    driver.start({0: 1500, 1: 1500})
    driver.write({0: 1000, 5: 2000})
    assert wire.log[-1] == [(0x06, bytes([0, 0, 0xF5, 0])), (0x1A, bytes([0, 0, 0xEA, 1]))]
    assert driver.read([0, 1]) == pytest.approx({0: 245 * 4.08, 1: 368 * 4.08})
    driver.close()


def kernel(wire: Wire, module: Any) -> Any:
    def ioctl(fd: int, request: int, argument: Any) -> None:
        if request == module.I2C_FUNCS:
            argument.value = 0x0EFF0009
        elif request == module.I2C_RDWR:
            messages = [bytes(argument.msgs[n]) for n in range(argument.nmsgs)]
            wire.transfer(argument.msgs[0].addr, [(message[0], message[1:]) for message in messages])
        elif request == module.I2C_SMBUS:
            smbus(argument)

    def smbus(call: Any) -> None:
        data, block = call.data.contents, call.size == module.I2C_SMBUS_I2C_BLOCK_DATA
        if call.read_write == module.I2C_SMBUS_WRITE:
            sent = bytes(data.block[1 : data.block[0] + 1]) if block else bytes([data.byte])
            return wire.transfer(0x40, [(call.command, sent)])
        length = data.block[0] if block else 1
        answer = wire.read_i2c_block_data(0x40, call.command, length)
        if block:
            data.block[1 : length + 1] = answer
        else:
            data.byte = answer[0]

    return ioctl
