"""Stand-ins for a terminal, a publisher and a driver that note when they were used."""

import time
from typing import Any

from zteleop.bus.session import Outlet


class TypedTerminal:
    """A terminal whose operator is this program, and whose screen nobody sees."""

    resumed, unicode, color = 0, True, True

    def __init__(self) -> None:
        self.typed = b""

    def read(self) -> bytes:
        typed, self.typed = self.typed, b""
        return typed

    def size(self) -> tuple[int, int]:
        return 100, 30

    def draw(self, lines: list[str]) -> None: ...


class StampedPublisher:
    """Notes when a publisher put what it says."""

    def __init__(self, publisher: Outlet) -> None:
        self._publisher, self.at = publisher, 0.0

    def put(self, *values: Any, **options: Any) -> None:
        self.at = time.perf_counter()
        self._publisher.put(*values, **options)


class StampedDriver:
    """Notes when a driver has written."""

    def __init__(self, driver: Any) -> None:
        self._driver, self.at = driver, 0.0
        self.tick_us, self.arming = driver.tick_us, driver.arming
        self.start, self.read, self.close, self.check = driver.start, driver.read, driver.close, driver.check

    def write(self, pulse_us: dict[int, float]) -> None:
        self._driver.write(pulse_us)
        self.at = time.perf_counter()
