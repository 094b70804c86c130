import errno
import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from unit.drivers.wire import Wire

from zteleop.drivers import pca9685
from zteleop.drivers.chip import POWER_UP, Chip
from zteleop.drivers.pca9685 import Pca9685, Pca9685Settings, open_driver
from zteleop.drivers.registers import ALL_LED_OFF_H, MODE1, MODE2, PRE_SCALE
from zteleop.drivers.simulated import SimulatedI2C
from zteleop.errors import ConfigError, DeviceError

NEUTRAL = {0: 1500.0, 1: 1500.0}
NEUTRAL_BLOCK = [(0x06, bytes([0, 0, 0x70, 1, 0, 0, 0x70, 1]))]


@pytest.fixture
def slept() -> list[float]:
    return []


@pytest.fixture
def driver(wire: Wire, slept: list[float]) -> Pca9685:
    return Pca9685(wire, Pca9685Settings(), slept.append)


@pytest.fixture
def driving(wire: Wire, driver: Pca9685) -> Pca9685:
    """A driver that is started, with its start forgotten."""
    driver.start(NEUTRAL)
    wire.log.clear()
    wire.reads.clear()
    return driver


def test_a_chip_after_power_up_is_brought_up_in_the_data_sheets_order(
    wire: Wire, driver: Pca9685, slept: list[float]
) -> None:
    driver.start(NEUTRAL)
    assert wire.log == [
        [(ALL_LED_OFF_H, b"\x10")],
        [(MODE1, b"\x30")],
        [(PRE_SCALE, b"\x65")],
        [(MODE2, b"\x04")],
        [(MODE1, b"\x20")],
        NEUTRAL_BLOCK,
    ]
    assert driver.read([0, 1, 2]) == {0: pytest.approx(368 * 4.08), 1: pytest.approx(368 * 4.08), 2: None}


def test_it_waits_a_period_before_sleep_and_for_the_oscillator_after(
    wire: Wire, driver: Pca9685, slept: list[float]
) -> None:
    driver.start(NEUTRAL)
    period, settling = slept
    assert period == pytest.approx(4096 * 31 / 25e6)
    assert settling >= 500e-6


def test_an_awake_chip_is_taken_over_without_a_gap(wire: Wire, driving: Pca9685, slept: list[float]) -> None:
    driving.write({0: 2000, 1: 1800})
    wire.log.clear()
    slept.clear()
    Pca9685(wire, Pca9685Settings(), slept.append).start(NEUTRAL)
    assert wire.log == [[(MODE1, b"\x20")], NEUTRAL_BLOCK]
    assert slept == []


def test_an_awake_chip_with_odd_outputs_gets_neutral_first_and_then_its_mode(
    wire: Wire, driving: Pca9685
) -> None:
    wire.chip.memory[MODE2] = 0x14
    wire.log.clear()
    driving.start(NEUTRAL)
    assert wire.log == [[(MODE1, b"\x20")], NEUTRAL_BLOCK, [(MODE2, b"\x04")]]


def test_an_awake_chip_at_another_frequency_is_stopped_in_order(
    wire: Wire, driving: Pca9685, slept: list[float]
) -> None:
    slept.clear()
    driver = Pca9685(wire, Pca9685Settings(frequency_hz=50), slept.append)
    driver.start(NEUTRAL)
    assert wire.log[:3] == [[(ALL_LED_OFF_H, b"\x10")], [(MODE1, b"\x30")], [(PRE_SCALE, b"\x79")]]
    assert slept[0] == pytest.approx(4096 * 102 / 25e6)
    assert wire.chip.memory[MODE1] == 0x20
    assert driver.read([0])[0] == pytest.approx(307 * 4.88)


def test_a_restart_left_pending_is_taken_up(wire: Wire, driving: Pca9685) -> None:
    wire.chip.memory[MODE1] = 0xA0
    driving.start(NEUTRAL)
    assert driving.read([0])[0] == pytest.approx(368 * 4.08)


def test_adjacent_channels_are_one_block_write(wire: Wire, driving: Pca9685) -> None:
    driving.write({1: 2000, 0: 1000})
    assert wire.log == [[(0x06, bytes([0, 0, 0xF5, 0, 0, 0, 0xEA, 1]))]]


def test_channels_apart_are_one_transaction(wire: Wire, driving: Pca9685) -> None:
    driving.write({0: 1000, 7: 2000})
    assert wire.log == [[(0x06, bytes([0, 0, 0xF5, 0])), (0x22, bytes([0, 0, 0xEA, 1]))]]


def test_adjacent_channels_are_read_in_one_block(wire: Wire, driving: Pca9685) -> None:
    driving.write({0: 1000, 1: 2000, 5: 1200})
    assert driving.read([5, 1, 0]) == pytest.approx({5: 1200, 1: 2000, 0: 1000}, abs=2.04)
    assert wire.reads == [(MODE1, 1), (PRE_SCALE, 1), (0x06, 8), (0x1A, 4)]


def test_arming_takes_as_long_as_the_settings_say(wire: Wire, driver: Pca9685) -> None:
    assert driver.arming == 2.0
    assert Pca9685(wire, Pca9685Settings(arming=0.5)).arming == 0.5


def test_writes_are_unconditional(wire: Wire, driving: Pca9685) -> None:
    driving.write(NEUTRAL)
    driving.write(NEUTRAL)
    assert wire.log == [NEUTRAL_BLOCK, NEUTRAL_BLOCK]


@pytest.mark.parametrize("fault", [errno.EREMOTEIO, errno.EIO, (errno.ETIMEDOUT, 4), (errno.EAGAIN, 7)])
def test_a_failed_or_torn_write_is_written_again_whole(
    wire: Wire, driving: Pca9685, fault: int | tuple[int, int]
) -> None:
    wire.faults = [fault, fault]
    driving.write({0: 1000, 1: 2000})
    assert len(wire.log) == 3
    assert driving.read([0, 1]) == pytest.approx({0: 245 * 4.08, 1: 490 * 4.08})


def test_the_third_failure_is_an_error_in_words(wire: Wire, driving: Pca9685) -> None:
    wire.faults = [errno.EIO] * 4
    with pytest.raises(DeviceError, match=r"^0x40 on /dev/i2c-1: EIO; check power"):
        driving.write(NEUTRAL)
    assert len(wire.log) == 3


def test_a_chip_that_is_not_there_says_who_is(wire: Wire, driver: Pca9685) -> None:
    wire.address = 0x70
    with pytest.raises(
        DeviceError, match=r"^nobody answers at 0x40 on /dev/i2c-1; found 0x70; .* \(i2cdetect -y 1"
    ):
        driver.start(NEUTRAL)


@pytest.mark.parametrize(
    ("register", "value", "words"),
    [
        (MODE1, 0x60, "MODE1 reads 0x60, not 0x20"),
        (MODE2, 0x0C, "MODE2 reads 0x0c, not 0x04"),
        (PRE_SCALE, 0x1E, "PRE_SCALE reads 0x1e, not 0x65"),
        (0x0D, 0x11, "LED1_OFF_H reads 0x11, not 0x01"),
    ],
)
def test_a_chip_that_holds_something_else_is_refused(register: int, value: int, words: str) -> None:
    class Forgetful(Wire):
        def read_i2c_block_data(self, address: int, place: int, length: int) -> list[int]:
            forgot = place == register and self.log[-1:] == [NEUTRAL_BLOCK]
            return [value] if forgot else super().read_i2c_block_data(address, place, length)

    driver = Pca9685(Forgetful(), Pca9685Settings(), lambda _: None)
    with pytest.raises(DeviceError, match=rf"^the PCA9685 at 0x40 on /dev/i2c-1 does not hold .*\({words}\)"):
        driver.start(NEUTRAL)


def test_an_external_clock_that_sticks_is_refused(wire: Wire, driver: Pca9685) -> None:
    wire.chip.memory[MODE1] |= 0x40
    with pytest.raises(DeviceError, match="MODE1 reads 0x60, not 0x20"):
        driver.start(NEUTRAL)


def test_check_notices_a_dip_of_the_supply_though_writes_succeed(wire: Wire, driving: Pca9685) -> None:
    driving.check()
    wire.chip.power_up()
    driving.write(NEUTRAL)
    with pytest.raises(DeviceError, match=r"MODE1 reads 0x11, not 0x20, PRE_SCALE reads 0x1e, not 0x65"):
        driving.check()
    driving.start(NEUTRAL)
    driving.check()


def test_closing_leaves_the_outputs_as_last_written(wire: Wire, driving: Pca9685) -> None:
    driving.write({0: 1700, 1: 1500})
    before = bytes(wire.chip.memory)
    driving.close()
    assert bytes(wire.chip.memory) == before


@pytest.mark.parametrize(
    ("pulse_us", "words"),
    [
        ({0: 0.0}, "channel 0, 0 us"),
        ({0: -1500.0}, "channel 0, -1500 us"),
        ({0: 17000.0}, "period of 16712 us"),
        ({0: float("nan")}, "channel 0, nan us"),
        ({16: 1500.0}, "channel 16"),
        ({-1: 1500.0}, "channel -1"),
    ],
)
def test_a_pulse_that_cannot_be_is_refused_before_anything_is_written(
    wire: Wire, driving: Pca9685, pulse_us: dict[int, float], words: str
) -> None:
    with pytest.raises(ConfigError, match=words):
        driving.write({5: 1500.0} | pulse_us)
    assert wire.log == []


def test_the_tick_is_of_the_real_prescale_and_oscillator(wire: Wire) -> None:
    assert Pca9685(wire, Pca9685Settings()).tick_us == pytest.approx(4.08)
    assert Pca9685(wire, Pca9685Settings(osc_hz=26e6)).tick_us == pytest.approx(106 / 26)


@given(st.dictionaries(st.integers(0, 15), st.floats(500, 2500), min_size=1), st.floats(24, 390))
def test_any_pulses_come_back_within_half_a_tick(pulse_us: dict[int, float], frequency_hz: float) -> None:
    chip = Chip(bytearray(POWER_UP))
    driver = Pca9685(SimulatedI2C(chip, "chip"), Pca9685Settings(frequency_hz=frequency_hz), lambda _: None)
    driver.start(dict.fromkeys(pulse_us, 1500.0))
    driver.write(pulse_us)
    assert driver.read(pulse_us) == pytest.approx(pulse_us, abs=driver.tick_us / 2 + 1e-9)


def test_a_second_driver_of_one_chip_is_refused_unless_it_is_the_watchdogs_hand(
    wire: Wire, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pca9685, "open_i2c", lambda bus: wire)
    monkeypatch.setattr(pca9685, "machine_folder", lambda: str(tmp_path))
    first = open_driver(Pca9685Settings())
    words = f"^the PCA9685 at 0x40 on /dev/i2c-1 is driven by process {os.getpid()} already"
    with pytest.raises(DeviceError, match=words):
        open_driver(Pca9685Settings())
    open_driver(Pca9685Settings(address=0x41)).close()
    open_driver(Pca9685Settings(), exclusive=False).close()
    first.close()
    open_driver(Pca9685Settings()).close()


def test_whoever_inherits_what_is_shared_keeps_others_off_too(wire: Wire, tmp_path: Path) -> None:
    driver = Pca9685(wire, Pca9685Settings())
    assert driver.shared() == []
    driver.claim(str(tmp_path / "lock"))
    inherited = [os.dup(file) for file in driver.shared()]
    driver.close()
    with pytest.raises(DeviceError, match="driven by process"):
        Pca9685(wire, Pca9685Settings()).claim(str(tmp_path / "lock"))
    for file in inherited:
        os.close(file)
    Pca9685(wire, Pca9685Settings()).claim(str(tmp_path / "lock"))
