"""An operator's switches, each said as true or false on a topic of its name."""

from collections.abc import Mapping

from zteleop.bus.node import Node
from zteleop.bus.publisher import Publisher
from zteleop.messages import Bool

EVERY = 1.0
"""s at which each is said again, for whoever comes later"""


class Switches:
    """Says each at once when it is switched, and again and again."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._said: dict[str, bool] = {}
        self._publishers: dict[str, Publisher[Bool]] = {}
        node.every(EVERY)(self._repeat)

    def heed(self, switches: Mapping[str, bool]) -> None:
        """Take in which are on and off; raises ConfigError for a name that is a topic of something else."""
        for name, on in switches.items():
            if self._said.get(name) is not on:
                self._said[name] = on
                self._say(name)

    def _repeat(self) -> None:
        for name in self._said:
            self._say(name)

    def _say(self, name: str) -> None:
        if name not in self._publishers:
            self._publishers[name] = self._node.publisher(name, Bool)
        self._publishers[name].publish(Bool(self._said[name]))
