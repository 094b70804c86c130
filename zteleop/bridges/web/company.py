"""Who speaks of what, who hears it, and how often: told to pages that look, and heard for nobody else."""

from collections import Counter, deque

from zteleop.bridges.web.slots import Slots
from zteleop.bridges.web.words import Graph, Topic, text
from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.presence import Endpoint, Kind, Tokens, endpoint_of
from zteleop.bus.session import Overheard
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
        self._pages: dict[str, Slots] = {}
        self._tokens: Tokens | None = None
        self._ring: Overheard | None = None
        self._seconds: deque[tuple[float, Counter[str]]] = deque(maxlen=SECONDS)
        """when each of the last began, and what was said in it; the present one at the end"""
        node.every(COUNT_EVERY)(self._count)
        node.every(TELL_EVERY)(self._tell)

    def look(self, page: str, slots: Slots, looks: bool) -> None:
        """Tell a page of the graph from now on, once a second, or no longer."""
        if not looks:
            self.forget(page)
            return
        self._pages[page] = slots
        if self._ring is None:
            self._tokens = self._tokens or Tokens(self._session, f"{self._prefix}live/**", MOST)
            self._ring = self._session.overhear(f"{self._prefix}**", DEPTH)
            self._seconds.clear()
            self._begin()

    def forget(self, page: str) -> None:
        """Take in that a page looks no longer, or is gone."""
        self._pages.pop(page, None)
        if not self._pages and self._ring:
            self._ring.undeclare()
            self._ring = None

    def _count(self) -> None:
        if self._ring is None:
            return
        _, said = self._seconds[-1]
        while (sample := self._ring.try_recv()) is not None:
            said[topic_of(sample.key.removeprefix(self._prefix)).name] += sample.is_put

    def _begin(self) -> None:
        self._seconds.append((clock.now(), Counter()))

    def _tell(self) -> None:
        if self._ring is None:
            return
        keys = self._tokens.there() if self._tokens else ()
        parts = [part for part in map(endpoint_of, keys) if part and "*" not in part.topic]
        said = sum((said for _, said in self._seconds), Counter())
        seconds = max(clock.now() - self._seconds[0][0], COUNT_EVERY)
        names = {topic_of(part.topic).name for part in parts if part.kind in ("pub", "sub")} | {*said}
        word = text(Graph([_topic(name, parts, said[name] / seconds) for name in sorted(names)]))
        for slots in self._pages.values():
            slots.put("graph", word)
        self._begin()


def _topic(name: str, parts: list[Endpoint], hz: float) -> Topic:
    own = [part for part in parts if topic_of(part.topic).name == name and part.kind in ("pub", "sub")]
    types = sorted({part.type for part in own})
    return Topic(name, types, _nodes(own, "pub"), _nodes(own, "sub"), round(hz, 2))


def _nodes(parts: list[Endpoint], kind: Kind) -> list[str]:
    """Return a name for each process; one that hears a topic by several names is one."""
    return sorted(node for node, _ in {(part.node, part.process) for part in parts if part.kind == kind})
