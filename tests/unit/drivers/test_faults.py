import errno
from pathlib import Path

import pytest

from zteleop.drivers.chip import POWER_UP
from zteleop.drivers.faults import Area, Fault, Faults, cut, next_fault
from zteleop.drivers.i2c import EREMOTEIO
from zteleop.drivers.simulated import SimulatedI2C, open_chip, open_registers
from zteleop.errors import ConfigError


@pytest.fixture
def path(tmp_path: Path) -> str:
    return str(tmp_path / "chip")


def bus(path: str) -> SimulatedI2C:
    return SimulatedI2C(open_chip(path), path)


def test_they_lie_behind_the_registers_little_endian(path: str) -> None:
    faults = Faults(path)
    faults.nack(1)
    faults.tear(2, after_bytes=3)
    faults.hang(4, ms=500)
    content = Path(path).read_bytes()
    assert content[:256] == POWER_UP
    assert content[256:] == bytes([1, 0, 0, 0, 2, 0, 0, 0, 4, 0, 0, 0, 3, 0, 0xF4, 1]) + bytes(12)
    faults.close()


def test_each_transfer_meets_one_and_counts_it_down(path: str) -> None:
    with Faults(path) as faults:
        faults.nack(2)
        faults.tear(1, after_bytes=3)
        faults.hang(1, ms=7)
        met = [next_fault(path, length=4) for _ in range(5)]
        assert faults.pending() == Area(after_bytes=3, ms=7)
    nack = Fault(EREMOTEIO)
    assert met == [Fault(errno.ETIMEDOUT, ms=7), nack, nack, Fault(EREMOTEIO, after_bytes=3), None]


def test_every_nth_transfer_fails_until_it_is_none(path: str) -> None:
    with Faults(path) as faults:
        faults.every(3)
        assert [bool(next_fault(path)) for _ in range(7)] == [False, False, True] * 2 + [False]
        faults.every(0)
        assert [next_fault(path) for _ in range(7)] == [None] * 7


@pytest.mark.parametrize(
    ("percent", "least", "most"), [(0, 0, 0), (10, 60, 140), (50, 430, 570), (100, 1000, 1000)]
)
def test_as_many_of_a_hundred_transfers_fail_as_were_asked_for(
    path: str, percent: int, least: int, most: int
) -> None:
    with Faults(path) as faults:
        faults.at_random(percent)
        assert least <= sum(bool(next_fault(path)) for _ in range(1000)) <= most


@pytest.mark.parametrize("length", [0, 3])
def test_a_read_or_a_write_that_is_short_enough_is_not_torn(path: str, length: int) -> None:
    with Faults(path) as faults:
        faults.tear(1, after_bytes=3)
        assert next_fault(path, length) is None
        assert faults.pending().tear == 1


def test_a_new_count_replaces_the_old_one(path: str) -> None:
    with Faults(path) as faults:
        faults.nack(5)
        faults.nack(1)
        assert faults.pending() == Area(nack=1)


def test_leaving_the_with_takes_them_all_out(path: str) -> None:
    with Faults(path) as faults:
        faults.nack(5)
        faults.hang(5, ms=1000)
    assert Path(path).read_bytes() == POWER_UP + bytes(28)
    assert bus(path).read_byte_data(0x40, 0xFE) == 0x1E


def test_closing_leaves_them_in(path: str) -> None:
    faults = Faults(path)
    faults.nack(1)
    faults.close()
    with pytest.raises(OSError, match="put in"):
        bus(path).read_byte_data(0x40, 0)


def test_a_dip_of_the_supply_keeps_the_faults_and_lets_writes_succeed(path: str) -> None:
    i2c = bus(path)
    i2c.write_byte_data(0x40, 0, 0x20)
    with Faults(path) as faults, open_registers(path) as registers:
        faults.tear(1, after_bytes=9)
        faults.brown_out()
        assert registers.snapshot() == POWER_UP
        assert faults.pending() == Area(tear=1, after_bytes=9)
        i2c.write_byte_data(0x40, 1, 0x05)
        assert registers.snapshot()[:2] == bytes([0x11, 0x05])


@pytest.mark.parametrize(
    ("after_bytes", "through"),
    [
        (0, [(6, b""), (20, b"")]),
        (2, [(6, b"ab"), (20, b"")]),
        (3, [(6, b"abc"), (20, b"")]),
        (4, [(6, b"abc"), (20, b"d")]),
        (9, [(6, b"abc"), (20, b"de")]),
    ],
)
def test_a_torn_transaction_is_cut_across_its_blocks(
    after_bytes: int, through: list[tuple[int, bytes]]
) -> None:
    assert cut([(6, b"abc"), (20, b"de")], after_bytes) == through


@pytest.mark.parametrize(
    ("figures", "words"),
    [
        ((-1, 0), "tear must be within 0..4294967295, found -1"),
        ((1, 65536), "after_bytes must be within 0..65535"),
    ],
)
def test_a_figure_that_does_not_fit_is_refused(path: str, figures: tuple[int, int], words: str) -> None:
    with Faults(path) as faults, pytest.raises(ConfigError, match=words):
        faults.tear(*figures)


def test_a_transfer_to_another_address_meets_none(path: str) -> None:
    i2c = bus(path)
    with Faults(path) as faults:
        faults.nack(1)
        with pytest.raises(OSError, match="nobody answers"):
            i2c.read_byte_data(0x41, 0)
        assert faults.pending().nack == 1
