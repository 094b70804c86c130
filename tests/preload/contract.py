"""What a driver of the PCA9685 promises, and what the chip on its bus must do, whatever stands for it."""

import re
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any, TypeVar
from unittest.mock import patch

import pytest

from zteleop.drivers import PulseDriver, port
from zteleop.drivers.faults import Faults
from zteleop.drivers.i2c import I2C
from zteleop.drivers.pca9685 import Pca9685, Pca9685Settings
from zteleop.drivers.registers import (
    ALL_LED_OFF_H,
    ALL_LED_ON_L,
    LED0_ON_L,
    MODE1,
    MODE2,
    PRE_SCALE,
    read_duty_ticks,
)
from zteleop.drivers.simulated import SimulatedI2C, open_chip, open_registers
from zteleop.errors import DeviceError

AWAKE, ASLEEP = 0x20, 0x30
NEUTRAL = {0: 1500.0, 1: 1500.0}
DRIVEN = {0: 1800.0, 1: 1200.0}
NEUTRAL_TICKS, DRIVEN_TICKS = [368, 368], [441, 294]


T = TypeVar("T", I2C, PulseDriver)


class Bench:
    """A chip that has just got power, seen from outside, and ways to open its bus."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.bus = re.escape(path)
        self.registers, self.faults = open_registers(path), Faults(path)
        self.faults.clear()
        self.faults.brown_out()
        self._opened: list[Any] = []

    def i2c(self) -> I2C:
        i2c: I2C = SimulatedI2C(open_chip(self.path), self.path)
        return self._keep(i2c)

    def driver(self, **settings: Any) -> PulseDriver:
        bus = SimulatedI2C(open_chip(self.path), self.path)
        driver: PulseDriver = Pca9685(bus, Pca9685Settings(**settings), lambda _: None)
        return self._keep(driver)

    def started(self, **settings: Any) -> PulseDriver:
        driver = self.driver(**settings)
        driver.start(NEUTRAL)
        return driver

    def ticks(self, *channels: int) -> list[int | None]:
        seen = self.registers.snapshot()
        return [read_duty_ticks(seen, channel) for channel in channels]

    def close(self) -> None:
        for thing in [*self._opened, self.registers, self.faults]:
            thing.close()

    def _keep(self, thing: T) -> T:
        self._opened.append(thing)
        return thing


Case = Callable[[Bench], None]
CASES: list[Case] = []


def hold(case: Case, bench: Bench) -> None:
    """Try a case in which every attempt counts, however long the machine stands still between two."""
    with patch.object(port, "TRIED_FOR", float("inf")):
        case(bench)


def case(function: Case) -> Case:
    CASES.append(function)
    return function


@contextmanager
def fails(words: str) -> Iterator[None]:
    with pytest.raises(DeviceError, match=words):
        yield


@case
def a_chip_after_power_up_is_brought_up_at_neutral(bench: Bench) -> None:
    driver = bench.started()
    seen = bench.registers.snapshot()
    assert (seen[MODE1], seen[MODE2], seen[PRE_SCALE]) == (AWAKE, 0x04, 101)
    assert bench.ticks(0, 1, 2, 15) == [*NEUTRAL_TICKS, None, None]
    assert driver.read([0, 1, 2]) == pytest.approx({0: 1501.44, 1: 1501.44, 2: None})


@case
def a_running_chip_is_adopted_without_a_gap(bench: Bench) -> None:
    bench.started().write(DRIVEN | {5: 1000.0})
    bench.started()
    assert bench.ticks(0, 1) == NEUTRAL_TICKS
    assert bench.ticks(5) == [245], "a chip that is brought up anew is first switched off as a whole"


@case
def a_chip_at_another_frequency_is_brought_up_anew(bench: Bench) -> None:
    bench.started().write(DRIVEN | {5: 1000.0})
    bench.started(frequency_hz=50)
    assert bench.registers.snapshot()[PRE_SCALE] == 121
    assert bench.ticks(0, 1, 5) == [307, 307, None]


@case
def the_last_pulse_outlives_its_driver(bench: Bench) -> None:
    driver = bench.started()
    driver.write(DRIVEN)
    driver.close()
    assert bench.driver().read([0, 1]) == pytest.approx({0: 441 * 4.08, 1: 294 * 4.08})


def one_transaction(bench: Bench, pulse_us: dict[int, float]) -> None:
    """Only a transaction of all the bytes together is long enough to be torn before its last one."""
    driver = bench.started()
    bench.faults.tear(1, 4 * len(pulse_us) - 1)
    driver.write(pulse_us)
    assert bench.faults.pending().tear == 0
    assert driver.read(pulse_us) == pytest.approx(pulse_us, abs=2.05)


@case
def adjacent_channels_are_one_transaction(bench: Bench) -> None:
    one_transaction(bench, DRIVEN)


@case
def channels_apart_are_one_transaction(bench: Bench) -> None:
    one_transaction(bench, {0: 1000.0, 7: 2000.0, 12: 1300.0})


@case
def sixteen_channels_are_one_transaction(bench: Bench) -> None:
    one_transaction(bench, {channel: 1000.0 + 50 * channel for channel in range(16)})


@case
def pre_scale_is_ignored_while_awake(bench: Bench) -> None:
    i2c = bench.i2c()
    i2c.write_byte_data(0x40, MODE1, AWAKE)
    i2c.write_byte_data(0x40, PRE_SCALE, 101)
    assert bench.registers.snapshot()[PRE_SCALE] == 0x1E
    i2c.write_byte_data(0x40, MODE1, ASLEEP)
    i2c.write_byte_data(0x40, PRE_SCALE, 101)
    assert i2c.read_byte_data(0x40, PRE_SCALE) == 101


@case
def without_auto_increment_every_byte_lands_in_one_register(bench: Bench) -> None:
    i2c = bench.i2c()
    i2c.write_i2c_block_data(0x40, LED0_ON_L, [1, 2, 3, 4])
    assert bench.registers.snapshot()[6:10] == bytes([4, 0, 0, 0x10])
    assert i2c.read_i2c_block_data(0x40, LED0_ON_L, 3) == [4, 4, 4]


@case
def pulses_are_read_though_somebody_cleared_auto_increment(bench: Bench) -> None:
    driver = bench.started()
    driver.write(DRIVEN)
    bench.i2c().write_byte_data(0x40, MODE1, 0x00)
    assert driver.read([0, 1]) == pytest.approx(DRIVEN, abs=2.05)
    with fails("MODE1 reads 0x00, not 0x20"):
        driver.check()


@case
def full_off_wins_over_a_pulse_and_over_full_on(bench: Bench) -> None:
    driver, i2c = bench.started(), bench.i2c()
    i2c.write_byte_data(0x40, LED0_ON_L + 3, 0x11)
    assert driver.read([0, 1]) == {0: None, 1: pytest.approx(1501.44)}
    i2c.write_byte_data(0x40, LED0_ON_L + 1, 0x10)
    assert bench.ticks(0) == [None]
    driver.write(NEUTRAL)
    assert bench.ticks(0) == [368]


@case
def all_led_reaches_every_channel_and_reads_0(bench: Bench) -> None:
    i2c = bench.i2c()
    i2c.write_byte_data(0x40, MODE1, AWAKE)
    i2c.write_i2c_block_data(0x40, ALL_LED_ON_L, [0, 0, 0x70, 0x01])
    assert bench.ticks(*range(16)) == [368] * 16
    assert i2c.read_i2c_block_data(0x40, ALL_LED_ON_L, 4) == [0] * 4
    i2c.write_byte_data(0x40, ALL_LED_OFF_H, 0x10)
    assert bench.ticks(*range(16)) == [None] * 16


@case
def a_chip_put_to_sleep_gives_no_pulses_until_it_is_restarted(bench: Bench) -> None:
    driver, i2c = bench.started(), bench.i2c()
    for mode1, read, ticks in (
        (ASLEEP, 0xB0, [None, None]),
        (AWAKE, 0xA0, [None, None]),
        (0xA0, AWAKE, NEUTRAL_TICKS),
    ):
        i2c.write_byte_data(0x40, MODE1, mode1)
        assert i2c.read_byte_data(0x40, MODE1) == read
        assert bench.ticks(0, 1) == ticks
    driver.check()


@case
def reserved_registers_do_not_answer(bench: Bench) -> None:
    i2c = bench.i2c()
    for register in (0x46, 0xF9, 0xFF):
        with pytest.raises(OSError, match=r"reserved|Remote I/O") as read:
            i2c.read_byte_data(0x40, register)
        with pytest.raises(OSError, match=r"reserved|Remote I/O") as written:
            i2c.write_byte_data(0x40, register, 1)
        assert read.value.errno == written.value.errno == 121


@case
def an_external_clock_that_sticks_is_refused(bench: Bench) -> None:
    bench.i2c().write_byte_data(0x40, MODE1, 0x51)
    with fails("MODE1 reads 0x60, not 0x20"):
        bench.started()


@case
def a_brown_out_is_noticed_though_writes_succeed_and_start_repairs_it(bench: Bench) -> None:
    driver = bench.started()
    driver.check()
    bench.faults.brown_out()
    driver.write(DRIVEN)
    assert driver.read([0, 1]) == {0: None, 1: None}
    with fails("MODE1 reads 0x11, not 0x20, PRE_SCALE reads 0x1e, not 0x65"):
        driver.check()
    driver.start(NEUTRAL)
    driver.check()
    assert bench.ticks(0, 1) == NEUTRAL_TICKS


@case
def a_torn_write_is_written_again_whole_at_once(bench: Bench) -> None:
    driver = bench.started()
    for after_bytes in (0, 3, 7):
        bench.faults.tear(2, after_bytes)
        driver.write(DRIVEN)
        assert bench.faults.pending().tear == 0
        assert bench.ticks(0, 1) == DRIVEN_TICKS
        driver.write(NEUTRAL)


@case
def three_torn_writes_are_an_error_and_half_of_them_stands(bench: Bench) -> None:
    driver = bench.started()
    bench.faults.tear(9, 4)
    with fails(f"^nobody answers at 0x40 on {bench.bus}; check power and wiring"):
        driver.write(DRIVEN)
    assert bench.faults.pending().tear == 9 - 3
    assert bench.ticks(0, 1) == [DRIVEN_TICKS[0], NEUTRAL_TICKS[1]]


@case
def two_lost_writes_are_made_good_and_a_third_is_an_error(bench: Bench) -> None:
    driver = bench.started()
    bench.faults.nack(2)
    driver.write(DRIVEN)
    assert bench.ticks(0, 1) == DRIVEN_TICKS
    bench.faults.nack(3)
    with fails(f"^nobody answers at 0x40 on {bench.bus}; check power and wiring"):
        driver.write(NEUTRAL)
    assert bench.faults.pending().nack == 0
    driver.write(NEUTRAL)
    assert bench.ticks(0, 1) == NEUTRAL_TICKS


@case
def two_lost_reads_are_made_good_and_a_third_is_an_error_in_words(bench: Bench) -> None:
    driver = bench.started()
    for read in (driver.check, lambda: driver.read([0])):
        bench.faults.nack(2)
        read()
        bench.faults.nack(3)
        with fails(f"^nobody answers at 0x40 on {bench.bus}; check power and wiring"):
            read()
    bench.faults.nack(3)
    with fails("it did when asked again: check for a loose wire"):
        driver.start(NEUTRAL)


@case
def a_bus_that_hangs_is_an_error_in_words(bench: Bench) -> None:
    driver = bench.started()
    bench.faults.hang(3, 10)
    with fails(f"^0x40 on {bench.bus}: no transfer within 20 ms, something holds SDA or SCL low"):
        driver.write(DRIVEN)
    assert bench.ticks(0, 1) == NEUTRAL_TICKS
    bench.faults.hang(2, 1)
    driver.write(DRIVEN)
    assert bench.ticks(0, 1) == DRIVEN_TICKS


@case
def a_chip_that_answers_every_second_time_comes_up_and_is_driven(bench: Bench) -> None:
    for every in (2, 3):
        bench.faults.every(every)
        driver = bench.started()
        for pulse_us, ticks in ((DRIVEN, DRIVEN_TICKS), (NEUTRAL, NEUTRAL_TICKS)) * 5:
            driver.write(pulse_us)
            driver.check()
            assert bench.ticks(0, 1) == ticks


@case
def a_bus_that_is_slow_does_all_transfers_of_two(bench: Bench) -> None:
    drivers = [bench.started(), bench.driver()]
    bench.faults.slow(20)
    with ThreadPoolExecutor(2) as people:
        list(people.map(lambda driver: driver.write(DRIVEN), drivers))
    assert bench.ticks(0, 1) == DRIVEN_TICKS
    bench.faults.slow(0)


@case
def faults_that_are_cleared_are_met_by_nobody(bench: Bench) -> None:
    driver = bench.started()
    with Faults(bench.path) as faults:
        faults.nack(1000)
        faults.tear(1000, 0)
        faults.hang(1000, 1)
        with fails("no transfer within"):
            driver.check()
    driver.check()
    driver.write(DRIVEN)


@case
def nobody_at_the_address_says_who_is_there(bench: Bench) -> None:
    bench.faults.nack(1)  # only transfers to the chip itself meet it
    with fails(f"^nobody answers at 0x41 on {bench.bus}; nor at any other"):
        bench.driver(address=0x41).start(NEUTRAL)
    with fails(f"at 0x41 on {bench.bus}; found 0x40; if that is the chip, set address = 0x40 "):
        bench.driver(address=0x41).start(NEUTRAL)
