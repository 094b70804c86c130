import os
from mmap import ACCESS_READ, ACCESS_WRITE
from pathlib import Path

import pytest

from zteleop.drivers.chip import POWER_UP
from zteleop.drivers.chip_file import FAULTS, FILE_SIZE, map_file, open_file
from zteleop.errors import DeviceError


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "chip"


@pytest.mark.parametrize("content", [b"", b"not a chip", bytes(300)])
def test_a_file_of_another_size_is_no_chip_and_gets_power(file: Path, content: bytes) -> None:
    file.write_bytes(content)
    os.close(open_file(str(file)))
    assert file.read_bytes() == POWER_UP + bytes(28)


def test_a_chip_from_before_there_were_faults_keeps_its_registers(file: Path) -> None:
    driving = bytes(range(256))
    file.write_bytes(driving)
    os.close(open_file(str(file)))
    assert file.read_bytes() == driving + bytes(28)


def test_a_chip_that_runs_is_left_alone(file: Path) -> None:
    running = os.urandom(FILE_SIZE)
    file.write_bytes(running)
    with map_file(str(file), ACCESS_READ) as memory:
        assert memory[:] == running
        assert memory[FAULTS] == running[256:]
    assert file.read_bytes() == running


@pytest.mark.parametrize("act", [open_file, lambda path: map_file(path, ACCESS_READ)])
def test_a_file_that_cannot_be_opened_names_the_setting(file: Path, act: object) -> None:
    file.write_text("")
    assert callable(act)
    words = r"^cannot open the simulated chip .*; set path under \[drivers\.simulated\]"
    with pytest.raises(DeviceError, match=words):
        act(str(file / "chip"))


def test_a_chip_whose_file_is_removed_is_one_without_power(file: Path) -> None:
    file.write_bytes(bytes(range(256)) + bytes(28))
    with map_file(str(file), ACCESS_WRITE) as memory:
        file.unlink()
        assert memory[:256] == POWER_UP
        memory[0:1] = b"\x01"
    assert file.read_bytes()[0] == 1


@pytest.mark.parametrize("content", [b"", b"x", bytes(FILE_SIZE - 1), bytes(5000)])
def test_a_chip_whose_file_is_cut_short_is_one_without_power(file: Path, content: bytes) -> None:
    file.write_bytes(bytes(range(256)) + bytes(28))
    with map_file(str(file), ACCESS_WRITE) as memory:
        file.write_bytes(content)
        assert memory[:256] == POWER_UP
        memory[0:1] = b"\x01"
    assert file.read_bytes()[0] == 1


def test_a_path_that_is_none_names_the_setting() -> None:
    with pytest.raises(DeviceError, match="embedded null byte; set path"):
        open_file("a\0b")


def test_whoever_watches_sees_the_file_that_took_the_chips_place(file: Path) -> None:
    os.close(open_file(str(file)))
    other = file.with_name("other")
    other.write_bytes(bytes(FILE_SIZE))
    with map_file(str(file), ACCESS_READ) as memory:
        other.replace(file)
        assert memory[:] == bytes(FILE_SIZE)
