import pytest
from unit.bus.fakes import Clock
from unit.nodes.fakes import Node

from zteleop.bus import clock as bus_clock


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    clock = Clock()
    monkeypatch.setattr(bus_clock, "now", clock.now)
    return clock


@pytest.fixture
def node() -> Node:
    return Node()
