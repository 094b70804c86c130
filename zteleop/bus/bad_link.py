"""A bad radio, imitated for simulated robots and their operators: what is said comes late, or not at all."""

from collections import deque
from collections.abc import Callable
from random import Random

from zteleop.bus import clock
from zteleop.bus.loop import Loop
from zteleop.bus.session import Outlet


class BadLink:
    """Makes outlets bad, each by the same measure; `latency` in s, `loss` is the share that is lost."""

    def __init__(self, loop: Loop, latency: float, loss: float, seed: int) -> None:
        self._loop = loop
        self._latency = latency
        self._loss = loss
        self._chance = Random(seed)

    def __call__(self, outlet: Outlet) -> Outlet:
        """Return an outlet that says what is said to it as late, and as often not."""
        return LateOutlet(outlet, self._loop, self._latency, self._loses)

    def _loses(self) -> bool:
        return self._chance.random() < self._loss


class LateOutlet:
    """Keeps what is said until it is due; what is kept at the end of the loop is lost."""

    def __init__(self, outlet: Outlet, loop: Loop, latency: float, loses: Callable[[], bool]) -> None:
        self._outlet = outlet
        self._latency = latency
        self._loses = loses
        self._under_way: deque[tuple[float, bytes, str, bytes | None]] = deque()
        self._arrival = loop.alarm(self._arrive)

    @property
    def matched(self) -> bool:
        """Somebody hears it."""
        return self._outlet.matched

    def put(self, payload: bytes, encoding: str, attachment: bytes | None) -> None:
        """Say bytes, unless they get lost."""
        if self._loses():
            return
        self._under_way.append((clock.now() + self._latency, payload, encoding, attachment))
        self._arrival.ring_at(self._under_way[0][0])

    def _arrive(self) -> None:
        while self._under_way and self._under_way[0][0] <= clock.now():
            self._outlet.put(*self._under_way.popleft()[1:])
        if self._under_way:
            self._arrival.ring_at(self._under_way[0][0])
