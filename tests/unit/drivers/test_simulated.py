import os
import stat
import time
from pathlib import Path

import pytest

from zteleop.drivers import open_driver
from zteleop.drivers.chip import POWER_UP
from zteleop.drivers.faults import Faults
from zteleop.drivers.pca9685 import Pca9685, Pca9685Settings, read_pulse_us
from zteleop.drivers.simulated import Registers, SimulatedI2C, default_path, open_chip, open_registers
from zteleop.errors import DeviceError


@pytest.fixture
def path(tmp_path: Path) -> str:
    return str(tmp_path / "runtime" / "zteleop" / "car.pca9685")


def started(path: str, neutral_us: dict[int, float]) -> Pca9685:
    driver = Pca9685(SimulatedI2C(open_chip(path), path), Pca9685Settings(), lambda _: None)
    driver.start(neutral_us)
    return driver


def test_a_chip_that_was_not_there_has_just_got_power(path: str, tmp_path: Path) -> None:
    with open_registers(path) as registers:
        assert registers.snapshot() == POWER_UP
    assert (tmp_path / "runtime" / "zteleop" / "car.pca9685").read_bytes() == POWER_UP + bytes(28)
    assert stat.S_IMODE(os.stat(os.path.dirname(path)).st_mode) == 0o700


def test_byte_n_of_the_file_is_register_n(path: str) -> None:
    started(path, {0: 1500}).close()
    with open(path, "rb") as file:
        registers = file.read()
    assert (registers[0], registers[1], registers[0xFE]) == (0x20, 0x04, 101)
    assert registers[6:10] == bytes([0, 0, 0x70, 1])


def test_the_chip_outlives_its_driver_and_keeps_the_last_pulse(path: str) -> None:
    driver = started(path, {0: 1500})
    driver.write({0: 1800})
    driver.close()
    with open_registers(path) as registers:
        assert read_pulse_us(registers.snapshot(), 0) == pytest.approx(1800, abs=2.04)


def test_a_watcher_sees_what_others_write(path: str) -> None:
    with open_registers(path) as registers:
        driver = started(path, {0: 1500})
        assert read_pulse_us(registers.snapshot(), 0) == pytest.approx(1500, abs=2.04)
        driver.write({0: 1200})
        assert read_pulse_us(registers.snapshot(), 0) == pytest.approx(1200, abs=2.04)
        driver.close()


def test_two_drivers_see_one_truth(path: str) -> None:
    actuator, watchdog = started(path, {0: 1500}), started(path, {0: 1500})
    actuator.write({0: 2000})
    assert watchdog.read([0])[0] == pytest.approx(2000, abs=2.04)
    watchdog.write({0: 1500})
    assert actuator.read([0])[0] == pytest.approx(1500, abs=2.04)


def test_a_watcher_cannot_write(path: str) -> None:
    with open_registers(path) as registers, pytest.raises(TypeError):
        registers._memory[0] = 1


def test_a_snapshot_waits_until_two_looks_agree() -> None:
    looks = [b"half", b"whole", b"whole", b"later"]

    class Memory:
        def __getitem__(self, _: object) -> bytes:
            return looks.pop(0)

    assert Registers(Memory()).snapshot() == b"whole"  # type: ignore[arg-type]


def test_a_second_actuator_is_refused_with_the_process_of_the_first(path: str) -> None:
    first = open_driver("simulated", {"path": path})
    words = f"{path} is driven by process {os.getpid()} already; stop it first"
    with pytest.raises(DeviceError, match=words):
        open_driver("simulated", {"path": path})
    open_driver("simulated", {"path": path}, exclusive=False).close()
    first.close()
    open_driver("simulated", {"path": path}).close()


def test_a_transfer_meets_the_fault_that_was_put_in(path: str) -> None:
    driver = started(path, {0: 1500, 1: 1500})
    i2c = SimulatedI2C(open_chip(path), path)
    with Faults(path) as faults, open_registers(path) as registers:
        faults.tear(1, after_bytes=3)
        with pytest.raises(OSError, match="put in") as torn:
            i2c.write_blocks(0x40, [(6, bytes([0, 0])), (10, bytes([1, 2, 3, 4]))])
        assert torn.value.errno == 121
        assert registers.snapshot()[6:14] == bytes([0, 0, 0x70, 1, 1, 0, 0x70, 1])
        faults.hang(1, ms=3)
        began = time.monotonic()
        with pytest.raises(TimeoutError):
            i2c.read_byte_data(0x40, 0)
        assert time.monotonic() - began >= 0.003
    driver.write({0: 1500, 1: 1500})
    assert driver.read([1])[1] == pytest.approx(1500, abs=2.04)


def test_the_simulated_esc_arms_at_once_unless_told_otherwise(path: str) -> None:
    for driver, arming in (
        (open_driver("simulated", {"path": path}, exclusive=False), 0.0),
        (open_driver("simulated", {"path": path, "arming": 1.5}, exclusive=False), 1.5),
    ):
        assert driver.arming == arming
        driver.close()


def test_nobody_answers_at_another_address(path: str) -> None:
    i2c = SimulatedI2C(open_chip(path), path, 0x41)
    with pytest.raises(OSError, match="nobody answers"):
        i2c.write_byte_data(0x40, 0, 0x20)
    with pytest.raises(OSError, match="nobody answers"):
        i2c.read_byte_data(0x40, 0)
    assert open_registers(path).snapshot() == POWER_UP


def test_the_default_is_in_the_users_runtime_folder(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", "/run/user/7")
    assert default_path("archangel") == "/run/user/7/zteleop/archangel.pca9685"
    monkeypatch.delenv("XDG_RUNTIME_DIR")
    assert default_path() == f"/tmp/zteleop-{os.getuid()}/zteleop/robot.pca9685"
