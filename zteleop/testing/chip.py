"""A driver for a chip that is not there."""

from collections.abc import Iterable, Mapping

from zteleop.errors import DeviceError


class MemoryChip:
    """Keeps what it was told, and fails as often as a test says."""

    tick_us = 4.08
    """of a PCA9685 at 60 Hz"""

    def __init__(self, arming: float = 0.0) -> None:
        self.arming = arming
        self.pulses: dict[int, float | None] = {}
        """What each channel puts out, in us."""
        self.writes: list[Mapping[int, float]] = []
        self.log: list[str] = []
        """Which of its methods were called."""
        self.broken: set[str] = set()
        """Which of them fail."""

    def shared(self) -> list[int]:
        return []

    def start(self, neutral_us: Mapping[int, float]) -> None:
        self._do("start", neutral_us)

    def write(self, pulse_us: Mapping[int, float]) -> None:
        self._do("write", pulse_us)

    def read(self, channels: Iterable[int]) -> dict[int, float | None]:
        self._do("read")
        return {channel: self.pulses.get(channel) for channel in channels}

    def check(self) -> None:
        self._do("check")

    def close(self) -> None:
        self.log.append("close")

    def _do(self, name: str, pulse_us: Mapping[int, float] | None = None) -> None:
        self.log.append(name)
        if name in self.broken:
            raise DeviceError(f"the chip does not take a {name}")
        if pulse_us:
            self.writes.append(pulse_us)
            self.pulses.update(pulse_us)
