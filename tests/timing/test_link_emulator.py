"""The cable itself, measured between two sockets, before anything is concluded from it."""

import socket
import statistics
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from itertools import pairwise
from typing import NamedTuple

import pytest
from faults.link.emulator import Way
from faults.link.network import DEAD, ROBOT, SOUND, Network, obstacle
from rig import every
from verdict import excusable

if obstacle():
    pytest.skip(obstacle(), allow_module_level=True)

PORT = 9000
HEADERS = 42
"""bytes of Ethernet, IP and UDP around a datagram"""
COST = 0.02
"""s that the emulator may add to each way"""
SEED = 7


class Ends(NamedTuple):
    """A socket on each machine; what one says the other hears."""

    network: Network
    operator: socket.socket
    robot: socket.socket

    def arrivals(self, times: int, period: float, size: int = 100) -> dict[int, tuple[float, float]]:
        """Send numbered datagrams to the robot; return when each left and came, in the order they came."""
        sent: dict[int, float] = {}
        arrived: dict[int, tuple[float, float]] = {}
        for number in every(period, times):
            sent[number] = time.monotonic()
            self.operator.send(number.to_bytes(4, "big").ljust(size, b"."))
            while self._receive(sent, arrived, 0.0):
                pass
        while len(arrived) < times and self._receive(sent, arrived, 0.3):
            pass
        return arrived

    def _receive(
        self, sent: dict[int, float], arrived: dict[int, tuple[float, float]], patience: float
    ) -> bool:
        self.robot.settimeout(patience)
        with suppress(BlockingIOError, TimeoutError):
            number = int.from_bytes(self.robot.recv(2048)[:4], "big")
            arrived[number] = (sent[number], time.monotonic())
            return True
        return False


@contextmanager
def ends_of(network: Network) -> Iterator[Ends]:
    with network.socket(network.operator) as operator, network.socket(network.robot) as robot:
        robot.bind((ROBOT, PORT))
        robot.settimeout(2.0)
        operator.connect((ROBOT, PORT))
        operator.send(b"")  # both learn the other's hardware address
        robot.connect(robot.recvfrom(1)[1])
        yield Ends(network, operator, robot)


@pytest.fixture(scope="module")
def network() -> Iterator[Network]:
    with Network(SEED) as network:
        yield network


@pytest.fixture
def ends(network: Network) -> Iterator[Ends]:
    network.set(SOUND)
    with ends_of(network) as ends:
        yield ends


def delays(arrivals: dict[int, tuple[float, float]]) -> list[float]:
    return [arrived - sent for sent, arrived in arrivals.values()]


def test_a_sound_cable_adds_nothing_and_loses_nothing(ends: Ends) -> None:
    with excusable(0.0025, ends.network):
        arrivals = ends.arrivals(100, 0.002)
        assert statistics.median(delays(arrivals)) < 0.005
    assert list(arrivals) == list(range(100))


def test_it_delays_each_frame(ends: Ends) -> None:
    ends.network.set(Way(delay=0.05))
    with excusable(COST / 2, ends.network):
        arrivals = ends.arrivals(50, 0.005)
        assert statistics.median(delays(arrivals)) < 0.05 + COST
    assert len(arrivals) == 50
    assert min(delays(arrivals)) >= 0.05


def test_jitter_spreads_the_delays_and_keeps_the_order(ends: Ends) -> None:
    ends.network.set(Way(delay=0.02, jitter=0.04))
    with excusable(COST, ends.network):
        arrivals = ends.arrivals(100, 0.01)
        assert 0.05 < max(delays(arrivals)) < 0.06 + 2 * COST
    assert list(arrivals) == list(range(100))
    assert min(delays(arrivals)) >= 0.02
    assert max(delays(arrivals)) - min(delays(arrivals)) > 0.015


def test_frames_overtake_each_other(ends: Ends) -> None:
    ends.network.set(Way(delay=0.03, overtaking=0.2))
    with excusable(COST / 2, ends.network):
        order = list(ends.arrivals(200, 0.002))
        ahead = sum(number > later for number, later in pairwise(order))
        assert 10 < ahead < 60, "of 200 a fifth should have overtaken, in a few groups"
    assert sorted(order) == list(range(200))


def test_it_loses_a_share_of_the_frames(ends: Ends) -> None:
    ends.network.set(Way(loss=0.3))
    assert 190 < len(ends.arrivals(300, 0.001)) < 230


def test_it_lets_through_no_more_than_its_rate_and_drops_what_its_queue_cannot_hold(ends: Ends) -> None:
    ends.network.set(Way(rate=64_000, queue=10))
    with excusable(COST / 2, ends.network):
        arrivals = ends.arrivals(40, 0.001, size=400 - HEADERS)  # each takes 50 ms
        assert len(arrivals) in (10, 11)
        first, *_, last = (arrived for _, arrived in arrivals.values())
        assert last - first == pytest.approx(0.05 * (len(arrivals) - 1), abs=COST)


def test_one_direction_may_be_dead(ends: Ends) -> None:
    ends.network.set(forth=SOUND, back=DEAD)
    assert len(ends.arrivals(20, 0.001)) == 20
    ends.robot.send(b"back")
    ends.operator.settimeout(0.2)
    with pytest.raises(TimeoutError):
        ends.operator.recv(100)


def test_a_black_hole_swallows_everything_and_gives_nothing_back(ends: Ends) -> None:
    ends.network.set(DEAD)
    assert not ends.arrivals(20, 0.001)
    ends.network.set(SOUND)
    assert len(ends.arrivals(20, 0.001)) == 20


def test_the_same_seed_loses_the_same_frames() -> None:
    seen = []
    for _ in range(2):
        with Network(SEED) as network, ends_of(network) as ends:
            network.set(forth=Way(loss=0.5), back=SOUND)
            seen.append(list(ends.arrivals(60, 0.001)))
    assert seen[0] == seen[1]
    assert 15 < len(seen[0]) < 45
