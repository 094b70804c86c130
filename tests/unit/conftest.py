"""What most of the rooms need: a clock that stands still, a node without a bus, and two vehicles."""

import pytest

from zteleop.bus import clock as bus_clock
from zteleop.messages import Channel, Vehicle
from zteleop.testing import Clock, FakeNode


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(bus_clock, "now", clock.now)
    return clock


@pytest.fixture
def node(clock: Clock) -> FakeNode:
    return FakeNode(clock=clock)


@pytest.fixture
def car() -> Vehicle:
    """The Donkeycar nodes' numbers, left being the larger one; throttle with asymmetric ends."""
    channels = [
        Channel("steering", 1, 1000.0, 1500.0, 2000.0, 290, 375, 460, 0),
        Channel("throttle", 0, 1000.0, 1500.0, 2000.0, 355, 370, 400, 0),
    ]
    return Vehicle("ackermann", channels, 1.0, 2.0, 0.25, 0.4, 5.0, 4.08, True, 9.0)


@pytest.fixture
def tank() -> Vehicle:
    channels = [
        Channel(name, i, 1000.0, 1500.0, 2000.0, 205, 307, 410, 0) for i, name in enumerate(("left", "right"))
    ]
    return Vehicle("differential", channels, 0.3, 1.5, 0.0, 0.0, 3.0, 4.08, True, 9.0)
