import errno

import pytest
from unit.drivers.wire import Wire

from zteleop.drivers.port import Port
from zteleop.drivers.registers import MODE1, MODE2
from zteleop.errors import DeviceError


@pytest.fixture
def port(wire: Wire) -> Port:
    return Port(wire, 0x40)


def test_registers_are_set_and_got(port: Port) -> None:
    port.set(MODE1, 0x30)
    assert port.get(MODE1) == 0x30
    assert port.get_block(MODE1, 3) == bytes([0x30, 0x04, 0xE2])


def test_only_an_os_error_is_put_in_words(port: Port) -> None:
    with pytest.raises(DeviceError, match=r"^0x40 on /dev/i2c-1: "), port.in_words():
        raise OSError(errno.EIO, "broken")
    with pytest.raises(DeviceError, match=r"^already$"), port.in_words():
        raise DeviceError("already")
    with pytest.raises(ZeroDivisionError), port.in_words():
        raise ZeroDivisionError


def test_a_missing_chip_is_searched_for_only_when_asked(wire: Wire, port: Port) -> None:
    wire.address = 0x41
    with (
        pytest.raises(DeviceError, match=r"at 0x40 on /dev/i2c-1; found 0x41 \(i2cdetect"),
        port.in_words(True),
    ):
        port.get(MODE1)
    with pytest.raises(DeviceError, match="check power"), port.in_words():
        port.get(MODE1)


def test_verify_masks_restart_and_names_what_differs(wire: Wire, port: Port) -> None:
    wire.chip.memory[MODE1] = 0xA0
    port.verify({MODE1: 0x20, MODE2: 0x04})
    with pytest.raises(DeviceError, match=r"\(MODE1 reads 0x20, not 0x30, MODE2 reads 0x04, not 0x14\)"):
        port.verify({MODE1: 0x30, MODE2: 0x14})


@pytest.mark.parametrize(("channels", "block_writes"), [(2, 1), (8, 1), (9, 0), (16, 0)])
def test_a_run_is_one_transaction_and_a_block_write_while_that_is_long_enough(
    wire: Wire, port: Port, channels: int, block_writes: int
) -> None:
    port.set(MODE1, 0x20)
    wire.log.clear()
    port.write([(6, bytes([0, 0, 7, 0] * channels))])
    assert len(wire.log) == 1
    assert wire.block_writes == block_writes
    assert wire.chip.memory[6 + 4 * channels - 2] == 7


def test_nothing_to_write_is_no_transfer(wire: Wire, port: Port) -> None:
    port.write([])
    assert wire.log == []
