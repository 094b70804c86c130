from typing import Any

import pytest

from zteleop.drivers.chip import POWER_UP, Chip
from zteleop.drivers.registers import (
    ALL_LED_OFF_H,
    ALL_LED_ON_L,
    LED0_ON_L,
    MODE1,
    MODE2,
    PRE_SCALE,
    read_duty_ticks,
)

AWAKE, ASLEEP = 0x20, 0x30


class Memory(bytearray):
    """Counts how often it is changed."""

    changes = 0

    def __setitem__(self, *change: Any) -> None:
        self.changes += 1
        super().__setitem__(*change)


@pytest.fixture
def chip() -> Chip:
    return Chip(bytearray(POWER_UP))


def ticks(chip: Chip, channel: int) -> int | None:
    return read_duty_ticks(bytes(chip.memory), channel)


def write(chip: Chip, register: int, *data: int) -> None:
    chip.write([(register, bytes(data))])


def test_power_up_is_the_data_sheets(chip: Chip) -> None:
    assert len(POWER_UP) == 256
    assert POWER_UP[:10] == bytes([0x11, 0x04, 0xE2, 0xE4, 0xE8, 0xE0, 0, 0, 0, 0x10])
    assert POWER_UP[0x42:0x46] == bytes([0, 0, 0, 0x10])
    assert POWER_UP[PRE_SCALE] == 0x1E
    write(chip, MODE1, AWAKE)
    chip.power_up()
    assert bytes(chip.memory) == POWER_UP


def test_without_auto_increment_every_byte_lands_in_one_register(chip: Chip) -> None:
    write(chip, LED0_ON_L, 1, 2, 3, 4)
    assert bytes(chip.memory[6:10]) == bytes([4, 0, 0, 0x10])
    assert chip.read(LED0_ON_L, 3) == bytes([4, 4, 4])


def test_with_auto_increment_a_block_fills_a_channel(chip: Chip) -> None:
    write(chip, MODE1, AWAKE)
    write(chip, LED0_ON_L, 0, 0, 0x70, 0x01)
    assert chip.read(LED0_ON_L, 4) == bytes([0, 0, 0x70, 0x01])
    assert ticks(chip, 0) == 368


def test_auto_increment_may_be_set_by_the_same_block(chip: Chip) -> None:
    write(chip, MODE1, AWAKE, 0x14)
    assert chip.memory[MODE2] == 0x14


def test_auto_increment_wraps_after_the_last_led_and_after_pre_scale(chip: Chip) -> None:
    write(chip, MODE1, ASLEEP)
    write(chip, 0x45, 0x00, ASLEEP, 0x05)
    assert (chip.memory[0x45], chip.memory[MODE2]) == (0, 0x05)
    write(chip, ALL_LED_OFF_H, 0x10, 101, ASLEEP, 0x06)
    assert (chip.memory[PRE_SCALE], chip.memory[MODE2]) == (101, 0x06)
    assert chip.read(0x45, 3) == bytes([0x10, ASLEEP, 0x06])


def test_pre_scale_is_ignored_while_awake(chip: Chip) -> None:
    write(chip, MODE1, AWAKE)
    write(chip, PRE_SCALE, 101)
    assert chip.memory[PRE_SCALE] == 0x1E
    write(chip, MODE1, ASLEEP)
    write(chip, PRE_SCALE, 101)
    assert chip.memory[PRE_SCALE] == 101


def test_pre_scale_is_never_below_3(chip: Chip) -> None:
    write(chip, PRE_SCALE, 0)
    assert chip.memory[PRE_SCALE] == 3


def test_all_led_fans_out_and_reads_0(chip: Chip) -> None:
    write(chip, MODE1, AWAKE)
    write(chip, ALL_LED_ON_L, 0, 0, 0x70, 0x01)
    assert [ticks(chip, channel) for channel in range(16)] == [368] * 16
    assert chip.read(ALL_LED_ON_L, 4) == bytes(4)
    assert bytes(chip.memory[ALL_LED_ON_L : ALL_LED_ON_L + 4]) == bytes(4)
    write(chip, ALL_LED_OFF_H, 0x10)
    assert [ticks(chip, channel) for channel in range(16)] == [None] * 16


def test_a_sleep_that_cuts_pulses_asks_for_a_restart(chip: Chip) -> None:
    write(chip, MODE1, AWAKE)
    write(chip, LED0_ON_L, 0, 0, 0x70, 0x01)
    write(chip, MODE1, ASLEEP)
    assert chip.memory[MODE1] == ASLEEP | 0x80
    write(chip, MODE1, AWAKE)
    assert chip.memory[MODE1] == AWAKE | 0x80
    assert ticks(chip, 0) is None
    write(chip, MODE1, AWAKE | 0x80)
    assert chip.memory[MODE1] == AWAKE
    assert ticks(chip, 0) == 368


def test_writing_a_pulse_restarts_too(chip: Chip) -> None:
    write(chip, MODE1, AWAKE)
    write(chip, LED0_ON_L, 0, 0, 0x70, 0x01)
    write(chip, MODE1, ASLEEP)
    write(chip, MODE1, AWAKE)
    write(chip, LED0_ON_L, 0)
    assert chip.memory[MODE1] == AWAKE


def test_a_sleep_after_all_off_needs_no_restart(chip: Chip) -> None:
    write(chip, MODE1, AWAKE)
    write(chip, LED0_ON_L, 0, 0, 0x70, 0x01)
    write(chip, ALL_LED_OFF_H, 0x10)
    write(chip, MODE1, ASLEEP)
    assert chip.memory[MODE1] == ASLEEP


def test_an_external_clock_stays_until_power_up(chip: Chip) -> None:
    write(chip, MODE1, ASLEEP | 0x40)
    write(chip, MODE1, AWAKE)
    assert chip.memory[MODE1] == AWAKE | 0x40


def test_bits_that_do_not_exist_are_not_kept(chip: Chip) -> None:
    write(chip, MODE1, AWAKE)
    write(chip, MODE2, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF)
    assert bytes(chip.memory[1:11]) == bytes([0x1F, 0xFE, 0xFE, 0xFE, 0xFE, 0xFF, 0x1F, 0xFF, 0x1F, 0x00])


@pytest.mark.parametrize("register", [0x46, 0xF9, 0xFF])
def test_reserved_registers_do_not_answer(chip: Chip, register: int) -> None:
    with pytest.raises(OSError, match="reserved"):
        write(chip, register, 1)
    with pytest.raises(OSError, match="reserved"):
        chip.read(register, 1)
    assert bytes(chip.memory) == POWER_UP


def test_what_came_before_a_reserved_register_is_latched(chip: Chip) -> None:
    with pytest.raises(OSError, match="0x50"):
        chip.write([(MODE1, bytes([AWAKE])), (0x50, b"\1")])
    assert chip.memory[MODE1] == AWAKE


def test_a_transaction_shows_in_one_change_of_memory() -> None:
    memory = Memory(POWER_UP)
    chip = Chip(memory)
    write(chip, MODE1, AWAKE)
    write(chip, LED0_ON_L, 0, 0, 0x70, 0x01, 0, 0, 0x70, 0x01)
    assert memory.changes == 2
    chip.write([(LED0_ON_L, bytes([0, 0, 9, 0])), (LED0_ON_L + 40, bytes([0, 0, 9, 0]))])
    assert memory.changes == 3
    assert (ticks(chip, 0), ticks(chip, 1), ticks(chip, 10)) == (9, 368, 9)
