"""A claim of time is kept, broken, or not judged, because processes waited for a core just then.

A machine that others use makes every deadline late now and then. So a test whose claim is a duration
measures, from the fault to what must follow, how long those who bring it about wanted a core and had
none. What is late by more fails at once; what is late by less shows the machine, and is tried again.
"""

import os
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import NamedTuple, Protocol

from rig import PATIENCE

from zteleop.chaos.waiting import Meter, judge

LOOK = 0.0005


class NotJudged(Exception):  # noqa: N818  no error of anybody's
    """The machine was late, and nobody knows whether the product was."""


class Bench(Protocol):
    """What a claim is about: a rig, a network."""

    @property
    def pids(self) -> list[int]:
        """The processes that bring about what is claimed."""


class Wait(NamedTuple):
    """What one claim met."""

    late: float
    """s beyond its bound"""
    waited: float
    """s for which its processes wanted a core"""


waits: list[Wait] = []
"""Of all claims so far; the summary tells the longest."""


def meter(*benches: Bench) -> Meter:
    """Measure from now on the waits of this process and of all that these benches are made of."""
    return Meter(lambda: [os.getpid(), *(pid for bench in benches for pid in bench.pids)])


def judged(seconds: float, within: float, waited: float, not_before: float = 0.0) -> None:
    """Assert a duration; raises NotJudged where waiting for a core explains that it is another."""
    waits.append(Wait(max(0.0, seconds - within), waited))
    found = f"{seconds:.4f} s of at most {within:.4f}, of which {waited:.4f} s were spent waiting for a core"
    verdict = judge(seconds, within, waited)
    if verdict == "not judged" or not_before - waited <= seconds < not_before:
        raise NotJudged(found)
    assert verdict == "in time", found
    assert seconds >= not_before, f"{found}; it came before {not_before:.4f} s"


class Deadline:
    """Runs from its making, which is the moment of a fault, until what must follow is seen."""

    def __init__(self, *benches: Bench) -> None:
        self._meter, self._began = meter(*benches), time.monotonic()

    def met(self, condition: Callable[[], object], what: str, within: float, not_before: float = 0.0) -> None:
        """Wait for what must follow, and judge how long it took."""
        while not condition():
            assert time.monotonic() - self._began < PATIENCE, f"not within {PATIENCE:g} s: {what}"
            self._meter.glance()
            time.sleep(LOOK)
        judged(time.monotonic() - self._began, within, self._meter.waited, not_before)


@contextmanager
def excusable(slack: float, *benches: Bench) -> Iterator[None]:
    """Assert what a machine alone can break that keeps processes waiting for `slack` seconds.

    Never for what must not be, such as motion after a stop: that no machine excuses.
    """
    its = meter(*benches)
    try:
        yield
    except AssertionError as error:
        waited = its.waited
        waits.append(Wait(0.0, waited))
        if waited > slack:
            raise NotJudged(f"{waited:.4f} s were spent waiting for a core: {error}") from error
        raise
