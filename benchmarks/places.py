"""Where a robot and its operator are: on one machine, or on two with a bad Wi-Fi between them."""

import random
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from processes import free_endpoint

TESTS = Path(__file__).parents[1] / "tests"
DELAY, LOSS = 0.02, 0.02
"""s each way, and share of the frames"""
OUTAGE, OUTAGE_EVERY = 0.5, 20.0
"""s of nothing at all, and s from one to the next on the average"""


class Air(Protocol):
    """What lies between the two; `outages` is how often nothing went through."""

    outages: int

    def tend(self, now: float) -> None:
        """Do what is due."""


class Place(NamedTuple):
    """What is put before a command so that it runs with the robot, or with its operator."""

    robot: list[str]
    operator: list[str]
    host: str
    air: Air

    def endpoint(self) -> str:
        """Return an endpoint of the robot that nobody else of this place has."""
        return f"tcp/{self.host}:{free_endpoint().rpartition(':')[2]}"


class Loopback:
    """One machine: nothing happens to what is said."""

    outages = 0

    def tend(self, now: float) -> None:
        """Do nothing."""


class Wifi:
    """Late, lossy, and now and then gone; `ways` are those of the link emulator of the tests."""

    def __init__(self, network: Any, ways: tuple[Any, Any], seconds: float) -> None:
        self._network, self._ways, self._every = network, ways, min(OUTAGE_EVERY, seconds / 2)
        self._random = random.Random(1)
        self._due, self._gone = 0.0, True
        self.outages = 0

    def tend(self, now: float) -> None:
        """Let the link go, or come back, when it is time; at first it is there."""
        if now < self._due:
            return
        self._gone = not self._gone
        self._network.set(self._ways[self._gone])
        self.outages += self._gone
        self._due = now + (OUTAGE if self._gone else self._every * self._random.uniform(0.5, 1.5))


@contextmanager
def loopback(seconds: float) -> Iterator[Place]:
    """Put both on this machine."""
    yield Place([], [], "127.0.0.1", Loopback())


@contextmanager
def wifi(seconds: float) -> Iterator[Place]:
    """Put them on two machines, each a network namespace; there is none unless `wifi_obstacle` is empty."""
    from faults.link.emulator import Way
    from faults.link.network import DEAD, ROBOT, Network, inside

    with Network() as network:
        ways = Way(delay=DELAY, loss=LOSS), DEAD
        yield Place(inside(network.robot), inside(network.operator), ROBOT, Wifi(network, ways, seconds))


def wifi_obstacle() -> str:
    """Say why there is no bad Wi-Fi on this machine; nothing where there is."""
    sys.path.insert(
        0, str(TESTS)
    )  # its link emulator is the only thing that a benchmark takes from the tests
    try:
        from faults.link.network import obstacle
    except ImportError as error:
        return f"disturbing a network needs the tests beside the benchmarks: {error}"
    return obstacle()


PLACES = {"loopback": loopback, "wifi": wifi}
