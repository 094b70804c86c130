from typing import Any

import pytest

from zteleop.bus.bad_link import BadLink
from zteleop.testing import Clock
from zteleop.testing.loop import FakeLoop


class Outlet:
    """Keeps what is said, and when."""

    matched = True

    def __init__(self, clock: Clock) -> None:
        self.clock, self.said = clock, []

    def put(self, payload: bytes, encoding: str, attachment: bytes | None) -> None:
        self.said.append((payload, self.clock.time))


@pytest.fixture
def loop(clock: Clock) -> Any:
    return FakeLoop(clock)


def test_everything_comes_later_by_the_same_time_and_in_its_order(loop: Any, clock: Clock) -> None:
    outlet = Outlet(clock)
    bad = BadLink(loop, 0.2, 0.0, 0)(outlet)
    said = []
    for number in range(5):
        bad.put(bytes([number]), "", None)
        said.append((bytes([number]), pytest.approx(clock.time + 0.2, abs=0.011)))
        loop.live(0.05)
    loop.live(1.0)
    assert outlet.said == said
    assert bad.matched


def test_so_much_of_it_never_comes_and_the_same_of_it_each_time(loop: Any, clock: Clock) -> None:
    def comes(seed: int) -> list[bytes]:
        outlet = Outlet(clock)
        bad = BadLink(loop, 0.0, 0.3, seed)(outlet)
        for number in range(1000):
            bad.put(number.to_bytes(2), "", None)
        loop.live(0.1)
        return [payload for payload, _ in outlet.said]

    assert len(comes(1)) == pytest.approx(700, abs=50)
    assert comes(1) == comes(1)
    assert comes(1) != comes(2)


def test_outlets_of_one_link_lose_each_their_own(loop: Any, clock: Clock) -> None:
    outlets, link = [Outlet(clock), Outlet(clock)], BadLink(loop, 0.0, 0.5, 7)
    bad = [link(outlet) for outlet in outlets]
    for number in range(100):
        for one in bad:
            one.put(bytes([number]), "", None)
    loop.live(0.1)
    assert outlets[0].said != outlets[1].said
