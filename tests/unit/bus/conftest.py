import pytest
from unit.bus.fakes import Clock

from zteleop.bus import clock as bus_clock


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(bus_clock, "now", clock.now)
    return clock
