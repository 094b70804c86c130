import errno
from types import SimpleNamespace

import pytest
from unit.drivers.wire import Wire

from zteleop.drivers import port as module
from zteleop.drivers.i2c import EREMOTEIO
from zteleop.drivers.port import ATTEMPTS, TRIED_FOR, Port
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
        pytest.raises(DeviceError, match=r"found 0x41; if that is the chip, set address = 0x41 \(i2cdetect"),
        port.in_words(True),
    ):
        port.get(MODE1)
    with pytest.raises(DeviceError, match="check power"), port.in_words():
        port.get(MODE1)


def test_the_bus_is_searched_once_a_fault(wire: Wire, port: Port) -> None:
    def miss() -> int:
        wire.reads.clear()
        with pytest.raises(DeviceError, match="found 0x41"), port.in_words(search=True):
            port.get(MODE1)
        return len(wire.reads)

    wire.address = 0x41
    assert [miss(), miss(), miss()] == [ATTEMPTS + 64, ATTEMPTS, ATTEMPTS]
    wire.address = 0x40
    with port.in_words(search=True):
        port.get(MODE1)
    wire.address = 0x41
    assert miss() == ATTEMPTS + 64


@pytest.mark.parametrize("act", ["get", "set", "get_block", "write"])
@pytest.mark.parametrize(
    ("lasts", "attempts"), [(0.0, ATTEMPTS), (TRIED_FOR / 4, ATTEMPTS), (TRIED_FOR + 0.01, 1)]
)
def test_what_fails_is_tried_again_at_once_but_not_on_a_slow_bus(
    wire: Wire, port: Port, monkeypatch: pytest.MonkeyPatch, act: str, lasts: float, attempts: int
) -> None:
    time, tries = [100.0], []

    def fail(address: int, *arguments: object) -> None:
        time[0] += lasts
        tries.append(arguments)
        raise OSError(EREMOTEIO, "no")

    monkeypatch.setattr(module, "time", SimpleNamespace(monotonic=lambda: time[0]))
    for name in ("read_byte_data", "read_i2c_block_data", "write_byte_data", "write_i2c_block_data"):
        monkeypatch.setattr(wire, name, fail)
    acts = {
        "get": lambda: port.get(MODE1),
        "set": lambda: port.set(MODE1, 0),
        "get_block": lambda: port.get_block(MODE1, 3),
        "write": lambda: port.write([(6, bytes(8))]),
    }
    with pytest.raises(OSError, match="no"):
        acts[act]()
    assert len(tries) == attempts


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
