"""Who speaks of what, who hears it, and how often: told to pages that look, and heard for nobody else."""

from collections import Counter, deque

from zteleop.bridges.web.lookers import Lookers
from zteleop.bridges.web.slots import Slots
from zteleop.bridges.web.words import Graph, Topic, text
from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.presence import Endpoint, Kind, Tokens, endpoints_of
from zteleop.bus.topics import topic_of

MOST = 1000
"""tokens of nodes that are looked at"""
DEPTH = 2000
"""messages between two counts; of a flood the rest is not counted"""
COUNT_EVERY, TELL_EVERY = 0.1, 1.0
"""s"""
SECONDS = 5
"""over which a rate is taken"""


class Company:
    """For the node's loop alone."""

    def __init__(self, node: Node) -> None:
        self._prefix = f"robot/{node.robot}/"
        self._session = node.membership.session
        self._lookers = Lookers(self._session, f"{self._prefix}**", DEPTH)
        self._tokens: Tokens | None = None
        self._seconds: deque[tuple[float, Counter[str]]] = deque(maxlen=SECONDS)
        """when each of the last began, and what was said in it; the present one at the end"""
        node.every(COUNT_EVERY)(self._count)
        node.every(TELL_EVERY)(self._tell)

    def look(self, page: str, slots: Slots, looks: bool) -> None:
        """Tell a page of the graph from now on, once a second, or no longer."""
        if not looks:
            self.forget(page)
            return
        if not self._lookers:
            self._tokens = self._tokens or Tokens(self._session, f"{self._prefix}live/**", MOST)
            self._seconds.clear()
            self._begin()
        self._lookers.look(page, slots)

    def forget(self, page: str) -> None:
        """Take in that a page looks no longer, or is gone."""
        self._lookers.forget(page)

    def _count(self) -> None:
        for sample in self._lookers.take():
            _, said = self._seconds[-1]
            said[topic_of(sample.key.removeprefix(self._prefix)).name] += sample.is_put

    def _begin(self) -> None:
        self._seconds.append((clock.now(), Counter()))

    def _tell(self) -> None:
        if not self._lookers:
            return
        keys = self._tokens.there() if self._tokens else ()
        parts = [part for key in keys for part in endpoints_of(key) if "*" not in part.topic]
        said = sum((said for _, said in self._seconds), Counter())
        seconds = max(clock.now() - self._seconds[0][0], COUNT_EVERY)
        names = {topic_of(part.topic).name for part in parts if part.kind in ("pub", "sub")} | {*said}
        topics = [_topic(name, parts, said[name] / seconds) for name in sorted(names)]
        self._lookers.tell("graph", text(Graph(topics)))
        self._begin()


def _topic(name: str, parts: list[Endpoint], hz: float) -> Topic:
    own = [part for part in parts if topic_of(part.topic).name == name and part.kind in ("pub", "sub")]
    types = sorted({part.type for part in own})
    return Topic(name, types, _nodes(own, "pub"), _nodes(own, "sub"), round(hz, 2))


def _nodes(parts: list[Endpoint], kind: Kind) -> list[str]:
    """Return a name for each process; one that hears a topic by several names is one."""
    return sorted(node for node, _ in {(part.node, part.process) for part in parts if part.kind == kind})
