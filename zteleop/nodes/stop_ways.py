"""The ways by which a stop is said: on the bus, and by a lane that needs none."""

from collections.abc import Iterator, Sequence

from zteleop.bus.lane.call import Call
from zteleop.bus.lane.wire import Answered
from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.bus.topics import TOPICS
from zteleop.control.proof import NEVER
from zteleop.messages import Stop


class Ways:
    """One robot's, by as many ways as there are; times in s."""

    def __init__(self, lane: Call | None) -> None:
        self._lane = lane
        self._publisher: Publisher[Stop] | None = None
        self._matched = False
        self._due = NEVER

    def join(self, node: Node, robot: str) -> None:
        """Say it on the bus as well, at once; to the node's own robot where none is named."""
        self._publisher = node.publisher(f"/{robot}/stop" if robot else "stop", Stop)
        self._due = NEVER

    def is_due(self, now: float) -> bool:
        """Say whether it is time to say it again: at the first listener at once, as nobody heard it."""
        return now >= self._due or (self._is_matched and not self._matched)

    def say(self, robot: str, stops: Sequence[Stop], now: float) -> None:
        """Say stops, or releases, by every way."""
        self._matched = self._is_matched
        self._due = now + TOPICS["stop"].every
        for stop in stops:
            if self._lane:
                self._lane.say(robot, stop)
            if self._publisher:
                self._publisher.publish(stop)

    def answers(self) -> Iterator[Answered]:
        """Yield what is answered on the lane; for the only one that asks there."""
        return self._lane.answers() if self._lane else iter(())

    @property
    def _is_matched(self) -> bool:
        return self._publisher is not None and self._publisher.matched
