"""One channel's calibration: a fraction of full range to a pulse width and back."""

from math import ceil, floor
from typing import Annotated, Literal

from msgspec import Meta, Struct

from zteleop.messages import Channel

PulseWidth = Annotated[
    float,
    Meta(
        ge=500,
        le=2500,
        extra_json_schema={"description": "us from 500 to 2500 (a tick is some 4 of them)"},
    ),
]
EVEN = 1e-9
"""ticks by which a float misses a whole one"""
Reverse = Literal["direct", "double_tap", "none"]
"""What an ESC makes of pulses below neutral: drives backward; brakes, and drives when they come again after
neutral; only brakes."""


class Servo(Struct, frozen=True, forbid_unknown_fields=True):
    """A servo or an ESC; swap min_us and max_us to reverse it. Positive is left, or forward."""

    channel: Annotated[int, Meta(ge=0, le=15)]
    min_us: PulseWidth = 1000.0
    neutral_us: PulseWidth = 1500.0
    max_us: PulseWidth = 2000.0
    dead_zone_us: Annotated[float, Meta(ge=0, le=200)] = 0.0
    """To either side of neutral, where a motor does not turn yet; steps begin beyond it."""
    slew_rate: Annotated[float, Meta(gt=0)] | None = None
    """Fractions of full range a second; None is as fast as it can."""
    reverse: Reverse = "direct"
    """As on crawlers; most cars' ESCs want to be tapped twice, which is done for whoever asks for a speed."""

    def __post_init__(self) -> None:
        if not min(self.min_us, self.max_us) < self.neutral_us < max(self.min_us, self.max_us):
            raise ValueError(
                f"neutral_us must lie between min_us and max_us, "
                f"found {self.min_us:g}, {self.neutral_us:g}, {self.max_us:g}"
            )

    def pulse_us(self, fraction: float) -> float:
        """Map -1, 0, 1 to min, neutral, max; beyond them stays at the end."""
        end = self.max_us if fraction > 0 else self.min_us
        return self.neutral_us + min(1.0, abs(fraction)) * (end - self.neutral_us)

    def fraction(self, pulse_us: float) -> float:
        """Map a pulse width back to a fraction; a width beyond the ends gives more than 1."""
        span = pulse_us - self.neutral_us
        towards_max = span * (self.max_us - self.neutral_us) > 0
        return span / (self.max_us - self.neutral_us if towards_max else self.neutral_us - self.min_us)

    def to_channel(self, name: str, tick_us: float) -> Channel:
        """Return the calibration in microseconds and in ticks of the chip."""
        return Channel(
            name=name,
            channel=self.channel,
            min_us=self.min_us,
            neutral_us=self.neutral_us,
            max_us=self.max_us,
            min_ticks=round(self.min_us / tick_us),
            neutral_ticks=round(self.neutral_us / tick_us),
            max_ticks=round(self.max_us / tick_us),
            dead_ticks=self._dead_ticks(tick_us),
        )

    def _dead_ticks(self, tick_us: float) -> int:
        """Return how many ticks off neutral, to either side, a pulse is still within the dead zone."""
        neutral = round(self.neutral_us / tick_us)
        up = floor((self.neutral_us + self.dead_zone_us) / tick_us + EVEN) - neutral
        down = neutral - ceil((self.neutral_us - self.dead_zone_us) / tick_us - EVEN)
        return max(0, up, down) if self.dead_zone_us else 0
