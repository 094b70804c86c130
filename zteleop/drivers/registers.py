"""The PCA9685's registers by the data sheet's names (rev. 4, section 7.3), and pulses to bytes and back."""

from collections.abc import Iterable, Mapping, Sequence

from zteleop.errors import ConfigError

MODE1, MODE2 = 0x00, 0x01
LED0_ON_L, LED15_OFF_H = 0x06, 0x45
ALL_LED_ON_L, ALL_LED_OFF_H, PRE_SCALE = 0xFA, 0xFD, 0xFE

RESTART, EXTCLK, AUTO_INCREMENT, SLEEP = 0x80, 0x40, 0x20, 0x10
"""Of MODE1."""
OUTDRV = 0x04
"""Of MODE2: totem pole; the other bits at 0 mean not inverted, change on STOP, low while OE is high."""
FULL_ON = FULL_OFF = 0x10
"""Of LEDn_ON_H and of LEDn_OFF_H, where it wins."""

TICKS = 4096
CHANNELS = range(16)
OSCILLATOR_HZ = 25e6


def prescale(frequency_hz: float, osc_hz: float = OSCILLATOR_HZ) -> int:
    """Return the PRE_SCALE nearest to a frequency (section 7.3.5).

    Raises ConfigError beyond 3..255, which is 24..1526 Hz with the nominal oscillator.
    """
    divider = osc_hz / (TICKS * frequency_hz)
    if not 3.5 < divider < 256.5:  # also refuses NaN
        low_hz, high_hz = osc_hz / (TICKS * 256), osc_hz / (TICKS * 4)
        raise ConfigError(f"frequency_hz must be within {low_hz:.0f}..{high_hz:.0f}, found {frequency_hz:g}")
    return round(divider) - 1


def longest_us(tick_us: float) -> float:
    """Return what a pulse must be shorter than: rounded to counts, its end must not be its beginning."""
    return (TICKS - 0.5) * tick_us


def tick_us(prescale: int, osc_hz: float = OSCILLATOR_HZ) -> float:
    """Return the length of one count in microseconds."""
    return (prescale + 1) / osc_hz * 1e6


def led_blocks(duty_ticks: Mapping[int, int]) -> list[tuple[int, bytes]]:
    """Return (first register, bytes) for each run of adjacent channels; ON is 0 and OFF the duty."""
    blocks: list[tuple[int, bytes]] = []
    for channel, off in sorted(duty_ticks.items()):
        register, data = LED0_ON_L + 4 * channel, bytes((0, 0, off & 0xFF, off >> 8))
        if blocks and blocks[-1][0] + len(blocks[-1][1]) == register:
            register, data = blocks[-1][0], blocks.pop()[1] + data
        blocks.append((register, data))
    return blocks


def led_runs(channels: Iterable[int], longest: int) -> list[tuple[int, int]]:
    """Return (first register, how many) for each run of adjacent channels, in parts of at most `longest`."""
    return [
        (first + offset, min(longest, len(data) - offset))
        for first, data in led_blocks(dict.fromkeys(channels, 0))
        for offset in range(0, len(data), longest)
    ]


def read_duty_ticks(registers: Sequence[int], channel: int) -> int | None:
    """Return how many of a period's 4096 counts an output is high.

    None where no pulse leaves: full off, always on, asleep, or woken but not restarted (section 7.3.1.1).
    """
    first = LED0_ON_L + 4 * channel
    on_l, on_h, off_l, off_h = registers[first : first + 4]
    if off_h & FULL_OFF or on_h & FULL_ON or registers[MODE1] & (SLEEP | RESTART):
        return None
    return ((off_l | off_h << 8) - (on_l | on_h << 8)) % TICKS or None


def read_pulse_us(registers: Sequence[int], channel: int, osc_hz: float = OSCILLATOR_HZ) -> float | None:
    """Return the pulse width in microseconds that a servo on that channel sees; None when there is none."""
    ticks = read_duty_ticks(registers, channel)
    return ticks and ticks * tick_us(registers[PRE_SCALE], osc_hz)


def register_name(register: int) -> str:
    """Return the data sheet's name of a register this package writes."""
    names = {MODE1: "MODE1", MODE2: "MODE2", PRE_SCALE: "PRE_SCALE"}
    led, part = divmod(register - LED0_ON_L, 4)
    return names.get(register) or f"LED{led}_{('ON_L', 'ON_H', 'OFF_L', 'OFF_H')[part]}"
