from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.drivers.chip import POWER_UP
from zteleop.drivers.registers import (
    MODE1,
    PRE_SCALE,
    TICKS,
    led_blocks,
    led_runs,
    longest_us,
    prescale,
    read_duty_ticks,
    read_pulse_us,
    register_name,
    tick_us,
)
from zteleop.errors import ConfigError


@pytest.mark.parametrize(
    ("frequency_hz", "expected", "real_hz", "tick", "ticks"),
    [
        (50, 121, 50.03, 4.88, [205, 256, 307, 359, 410]),
        (60, 101, 59.84, 4.08, [245, 306, 368, 429, 490]),
    ],
)
def test_prescale_is_the_data_sheets(
    frequency_hz: float, expected: int, real_hz: float, tick: float, ticks: list[int]
) -> None:
    assert prescale(frequency_hz) == expected
    assert tick_us(expected) == pytest.approx(tick)
    assert 1e6 / (4096 * tick_us(expected)) == pytest.approx(real_hz, abs=0.01)
    assert [round(width / tick_us(expected)) for width in (1000, 1250, 1500, 1750, 2000)] == ticks


def test_prescale_reaches_both_ends_and_the_power_up_value() -> None:
    assert [prescale(hz) for hz in (24, 200, 1526)] == [253, 0x1E, 3]


def test_prescale_follows_the_real_oscillator() -> None:
    assert prescale(60, 26e6) == 105
    assert tick_us(105, 26e6) == pytest.approx(4.077, abs=0.001)


@pytest.mark.parametrize("frequency_hz", [23.0, 2000.0, float("nan"), float("inf")])
def test_a_frequency_beyond_the_prescaler_is_refused(frequency_hz: float) -> None:
    with pytest.raises(ConfigError, match=r"24\.\.1526"):
        prescale(frequency_hz)


def test_adjacent_channels_share_a_block_in_order() -> None:
    assert led_blocks({1: 0x171, 0: 0x0FF}) == [(0x06, bytes([0, 0, 0xFF, 0, 0, 0, 0x71, 1]))]


def test_other_channels_get_a_block_of_their_own() -> None:
    assert [(register, len(data)) for register, data in led_blocks({0: 1, 1: 1, 4: 1, 15: 1})] == [
        (0x06, 8),
        (0x16, 4),
        (0x42, 4),
    ]


def test_adjacent_channels_are_one_run_in_parts_that_are_not_too_long() -> None:
    assert led_runs([1, 5, 0], 32) == [(0x06, 8), (0x1A, 4)]
    assert led_runs(range(9), 32) == [(0x06, 32), (0x26, 4)]
    assert led_runs([2], 1) == [(0x0E, 1), (0x0F, 1), (0x10, 1), (0x11, 1)]
    assert led_runs([], 32) == []


def image(led: Sequence[int] = (0, 0, 0x70, 0x01), mode1: int = 0x20, pre_scale: int = 101) -> bytearray:
    registers = bytearray(POWER_UP)
    registers[MODE1], registers[PRE_SCALE] = mode1, pre_scale
    registers[0x0A:0x0E] = bytes(led)
    return registers


def test_the_longest_pulse_ends_before_the_next_begins() -> None:
    longest = longest_us(4.0)
    assert round((longest - 0.01) / 4.0) == TICKS - 1
    assert round((longest + 0.01) / 4.0) == TICKS, "which is where it begins"


def test_a_pulse_is_read_with_the_real_tick() -> None:
    assert read_duty_ticks(image(), 1) == 368
    assert read_pulse_us(image(), 1) == pytest.approx(368 * 4.08)
    assert read_pulse_us(image(), 1, osc_hz=26e6) == pytest.approx(368 * 4.08 * 25 / 26)


def test_a_pulse_may_start_late_and_wrap() -> None:
    assert read_duty_ticks(image(led=(0x00, 0x0F, 0x70, 0x00)), 1) == 0x070 + 4096 - 0xF00


@pytest.mark.parametrize(
    "registers",
    [
        image(led=(0, 0, 0x70, 0x11)),
        image(led=(0, 0x10, 0x70, 0x01)),
        image(led=(0, 0x10, 0x70, 0x11)),
        image(led=(0, 0, 0, 0)),
        image(mode1=0x30),
        image(mode1=0xA0),
        POWER_UP,
    ],
    ids=["full off", "always on", "off wins over on", "ON equals OFF", "asleep", "not restarted", "power-up"],
)
def test_there_is_no_pulse_when(registers: Sequence[int]) -> None:
    assert read_duty_ticks(registers, 1) is None
    assert read_pulse_us(registers, 1) is None


@given(st.floats(500, 2500), st.integers(0, 15), st.sampled_from([24.0, 50.0, 60.0, 100.0, 330.0]))
def test_any_pulse_comes_back_within_half_a_tick(width: float, channel: int, frequency_hz: float) -> None:
    pre = prescale(frequency_hz)
    registers = image(pre_scale=pre)
    [(first, data)] = led_blocks({channel: round(width / tick_us(pre))})
    registers[first : first + 4] = data
    assert read_pulse_us(registers, channel) == pytest.approx(width, abs=tick_us(pre) / 2 + 1e-9)


def test_registers_are_called_what_the_data_sheet_calls_them() -> None:
    assert [register_name(n) for n in (0, 1, 0xFE, 6, 0x0D, 0x45)] == [
        "MODE1",
        "MODE2",
        "PRE_SCALE",
        "LED0_ON_L",
        "LED1_OFF_H",
        "LED15_OFF_H",
    ]
