"""How long commands take on their way through one process, told once a second while there are any."""

from collections.abc import Callable, Sequence

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.topics import TOPICS
from zteleop.messages import Hop, Latency

ACT_TO_BUS = "act to bus"
DOOR_TO_ACTUATOR, ACTUATOR_TO_CHIP = "door to actuator", "actuator to chip"
ROBOT = "actuator"
"""who says the last two; the first says an input, by the name that everything calls it"""
MOST = 400
"""of one hop in a second; a robot steps 200 times for what arrives"""


class Times:
    """Those of one process; `by` tells who says so. A process through which nothing goes is not woken."""

    def __init__(self, node: Node, by: Callable[[], str]) -> None:
        self._by = by
        self._hops: dict[str, list[float]] = {}
        self._told = node.publisher("latency", Latency)
        self._due = node.membership.loop.alarm(self._tell)

    def note(self, hop: str, seconds: float) -> None:
        """Note how long a command took on a part of its way."""
        if not self._hops:
            self._due.ring_at(clock.now() + TOPICS["latency"].every)
        taken = self._hops.setdefault(hop, [])
        if len(taken) < MOST:
            taken.append(seconds)

    def _tell(self) -> None:
        hops, self._hops = self._hops, {}
        self._told.publish(Latency(self._by(), [_hop(name, taken) for name, taken in hops.items()]))


def _hop(name: str, taken: Sequence[float]) -> Hop:
    # by hand: statistics would be more to import than all of this folder
    return Hop(name, len(taken), sorted(taken)[len(taken) // 2], max(taken))
