"""What every driver promises, whatever it writes to; a new one adds its bench here."""

import errno
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Protocol
from unittest.mock import patch

import pytest
from unit.drivers.kernel import FakeKernel, refuse

from zteleop.drivers import DRIVERS, PulseDriver, port
from zteleop.drivers.faults import Faults
from zteleop.drivers.pca9685 import Pca9685, Pca9685Settings
from zteleop.drivers.registers import read_pulse_us
from zteleop.drivers.simulated import SimulatedI2C, open_chip, open_registers
from zteleop.drivers.sysfs_pwm import SysfsPwm, SysfsPwmSettings
from zteleop.errors import ConfigError, DeviceError

NEUTRAL = {0: 1500.0, 1: 1530.0}
DRIVEN = {0: 1800.0, 1: 1200.0}


class Bench(Protocol):
    """A chip that has just got power, seen from outside."""

    def driver(self) -> PulseDriver: ...
    def width_us(self, channel: int) -> float | None: ...

    def lose(self, accesses: int) -> None:
        """Let so many of the next ones fail."""

    def forget(self) -> None:
        """Lose every setting, as after a dip of the supply, or of the module."""

    def close(self) -> None: ...


class Pca9685Bench:
    def __init__(self, folder: Path) -> None:
        self._path = str(folder / "chip")
        self._registers = open_registers(self._path)
        self._faults = Faults(self._path)

    def driver(self) -> PulseDriver:
        bus = SimulatedI2C(open_chip(self._path), self._path)
        return Pca9685(bus, Pca9685Settings(), lambda _: None)

    def width_us(self, channel: int) -> float | None:
        return read_pulse_us(self._registers.snapshot(), channel)

    def lose(self, accesses: int) -> None:
        self._faults.nack(accesses)

    def forget(self) -> None:
        self._faults.brown_out()

    def close(self) -> None:
        self._registers.close()
        self._faults.close()


class SysfsPwmBench:
    def __init__(self, folder: Path) -> None:
        self._kernel = FakeKernel(f"{folder}/pwmchip0")
        self._settings = SysfsPwmSettings(folder=str(folder))

    def driver(self) -> PulseDriver:
        return SysfsPwm(self._settings, self._kernel, lambda _: None)

    def width_us(self, channel: int) -> float | None:
        width = self._kernel.width_ns(channel)
        return width and width / 1000

    def lose(self, accesses: int) -> None:
        self._kernel.failing = [refuse(errno.EIO)] * accesses

    def forget(self) -> None:
        self._kernel.power_cycle()

    def close(self) -> None:
        """Nothing is open."""


BENCHES: dict[str, Callable[[Path], Bench]] = {
    "pca9685": Pca9685Bench,
    "simulated": Pca9685Bench,
    "sysfs_pwm": SysfsPwmBench,
}


def test_every_driver_has_a_bench() -> None:
    assert BENCHES.keys() == DRIVERS.keys()


@pytest.fixture(params=sorted({"pca9685", "sysfs_pwm"}))
def bench(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Bench]:
    bench = BENCHES[request.param](tmp_path)
    with patch.object(port, "TRIED_FOR", float("inf")):
        yield bench
    bench.close()


@pytest.fixture
def driver(bench: Bench) -> PulseDriver:
    driver = bench.driver()
    driver.start(NEUTRAL)
    return driver


def near(pulse_us: dict[int, float]) -> object:
    return pytest.approx(pulse_us, abs=2.05)


def test_it_comes_up_at_neutral_and_no_other_channel_does(bench: Bench, driver: PulseDriver) -> None:
    assert {channel: bench.width_us(channel) for channel in NEUTRAL} == near(NEUTRAL)
    assert driver.read([0, 1, 2]) == {**driver.read([0, 1]), 2: None}


def test_what_is_written_leaves_the_chip_and_is_read(bench: Bench, driver: PulseDriver) -> None:
    driver.write(DRIVEN)
    assert {channel: bench.width_us(channel) for channel in DRIVEN} == near(DRIVEN)
    assert driver.read(DRIVEN) == near(DRIVEN)


def test_one_channel_is_written_and_the_other_stays(bench: Bench, driver: PulseDriver) -> None:
    driver.write({1: 1200.0})
    assert (bench.width_us(0), bench.width_us(1)) == (
        pytest.approx(1500, abs=2.05),
        pytest.approx(1200, abs=2.05),
    )


def test_the_last_pulse_outlives_its_driver(bench: Bench, driver: PulseDriver) -> None:
    """Which is why there is a watchdog, and why it can read what a dead actuator has left."""
    driver.write(DRIVEN)
    driver.close()
    assert bench.driver().read(DRIVEN) == near(DRIVEN)


def test_a_successor_brings_neutral(bench: Bench, driver: PulseDriver) -> None:
    driver.write(DRIVEN)
    bench.driver().start(NEUTRAL)
    assert bench.width_us(0) == pytest.approx(1500, abs=2.05)


def test_two_that_are_lost_are_made_good_and_a_third_is_told(bench: Bench, driver: PulseDriver) -> None:
    bench.lose(2)
    driver.write(DRIVEN)
    assert bench.width_us(0) == pytest.approx(1800, abs=2.05)
    bench.lose(3)
    with pytest.raises(DeviceError):
        driver.write({0: 1500.0})
    bench.lose(3)
    with pytest.raises(DeviceError):
        driver.read([0])
    bench.lose(0)


def test_a_chip_that_forgot_is_noticed_gives_no_pulses_and_is_brought_up_again(
    bench: Bench, driver: PulseDriver
) -> None:
    driver.check()
    bench.forget()
    with pytest.raises(DeviceError):
        driver.check()
    assert driver.read([0, 1]) == {0: None, 1: None}
    driver.start(NEUTRAL)
    driver.check()
    assert bench.width_us(1) == pytest.approx(1530, abs=2.05)


@pytest.mark.parametrize("pulse_us", [{16: 1500.0}, {0: -1.0}, {0: 17_000.0}, {0: float("nan")}])
def test_what_cannot_be_moves_nothing(bench: Bench, driver: PulseDriver, pulse_us: dict[int, float]) -> None:
    with pytest.raises(ConfigError):
        driver.write({1: 1200.0} | pulse_us)
    assert bench.width_us(1) == pytest.approx(1530, abs=2.05)


def test_a_tick_is_a_4096th_of_a_period(driver: PulseDriver) -> None:
    assert driver.tick_us == pytest.approx(1e6 / 60 / 4096, rel=0.01)
    assert driver.arming == 2.0
    assert driver.shared() == []
