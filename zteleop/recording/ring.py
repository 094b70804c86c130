"""The last minute of every topic in bounded memory; pure: each message brings its own time."""

from collections import deque
from collections.abc import Collection
from typing import NamedTuple

from zteleop.bus.tap import Raw

SECONDS = 60.0
TOPIC_BYTES = 2 * 2**20
KNOWN_BYTES, OTHER_BYTES = 20 * 2**20, 4 * 2**20
"""bytes of all known topics together, and of all others"""
TOPICS_AT_MOST = 64
OVERHEAD = 300
"""bytes that a message costs besides its own"""
LONGEST_PATH = 200
SLACK = 0.95
"""share of a pool that is left when it was full, so that not each message has to make room"""
FLOOD = 200
"""messages a second of one topic, from which on their number is told"""


class Snapshot(NamedTuple):
    """What a ring held at one moment."""

    messages: list[Raw]
    """in the order of time"""
    topics: int
    floods: dict[str, list[tuple[int, int]]]
    """per topic: a second of the bus clock, and how many messages it had at least"""
    elsewhere: int
    """messages on topics for which there was no room, since the snapshot before"""


class Lane:
    """The messages of one topic."""

    def __init__(self) -> None:
        self.kept: deque[Raw] = deque()
        self.size = 0
        self.rates: deque[list[int]] = deque(maxlen=int(SECONDS) + 1)

    def add(self, raw: Raw) -> None:
        if self.kept and self.kept[-1].encoding == raw.encoding:
            raw = raw._replace(encoding=self.kept[-1].encoding, path=self.kept[-1].path)  # one text for all
        self.kept.append(raw)
        self.size += _size(raw)
        second = int(raw.at)
        if not self.rates or self.rates[-1][0] != second:
            self.rates.append([second, 0])
        self.rates[-1][1] += 1

    def drop(self) -> int:
        """Forget the oldest message; return its size."""
        size = _size(self.kept.popleft())
        self.size -= size
        return size


class Pool:
    """Topics that share an amount of memory: who uses most of it makes room."""

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self.size = 0
        self.lanes: dict[str, Lane] = {}

    def add(self, raw: Raw) -> None:
        lane = self.lanes.get(raw.path)
        if lane is None:
            lane = self.lanes[raw.path] = Lane()
        lane.add(raw)
        self.size += _size(raw)
        while lane.kept and (lane.size > TOPIC_BYTES or lane.kept[0].at < raw.at - SECONDS):
            self.size -= lane.drop()
        if self.size > self._limit:
            self._make_room()

    def _make_room(self) -> None:
        while self.size > SLACK * self._limit:
            self.size -= max(self.lanes.values(), key=lambda lane: lane.size).drop()

    def forget(self, before: float) -> None:
        """Drop what is older; a topic without a message is gone."""
        for path, lane in list(self.lanes.items()):
            while lane.kept and lane.kept[0].at < before:
                self.size -= lane.drop()
            if not lane.kept:
                del self.lanes[path]


class Ring:
    """Keeps the last SECONDS; what is said on other topics never costs a `known` one its room.

    Of two messages that were taken at once, the topic that stands first among the known is the earlier.
    """

    def __init__(self, known: Collection[str]) -> None:
        self._known_paths = {path: number for number, path in enumerate(known)}
        self._known = Pool(KNOWN_BYTES)
        self._others = Pool(OTHER_BYTES)
        self._room = TOPICS_AT_MOST - len(self._known_paths)
        self._swept = float("-inf")
        self._newest = float("-inf")
        self._elsewhere = 0

    @property
    def size(self) -> int:
        """Bytes in use, about."""
        return self._known.size + self._others.size

    def add(self, raw: Raw) -> None:
        """Keep a message, none of which is older than the one before."""
        self._newest = raw.at
        if raw.at - self._swept >= 1.0:
            self._swept = raw.at
            self._forget()
        if raw.path in self._known_paths:
            self._known.add(raw)
        elif raw.path in self._others.lanes or self._fits(raw):
            self._others.add(raw)
        else:
            self._elsewhere += 1

    def said_on(self, topic: str) -> list[Raw]:
        """Return what was said on a topic, and on those below it, the oldest first."""
        lanes = self._known.lanes | self._others.lanes
        below = f"{topic}/"
        wanted = [lane for path, lane in lanes.items() if path == topic or path.startswith(below)]
        return sorted((raw for lane in wanted for raw in lane.kept), key=lambda raw: raw.at)

    def snapshot(self) -> Snapshot:
        """Return what was said in the last SECONDS in which anything was."""
        self._forget()
        lanes = self._known.lanes | self._others.lanes
        in_order = sorted(lanes, key=lambda path: self._known_paths.get(path, TOPICS_AT_MOST))
        messages = sorted((raw for path in in_order for raw in lanes[path].kept), key=lambda raw: raw.at)
        first = self._newest - SECONDS
        floods = {
            path: [(second, count) for second, count in lane.rates if count >= FLOOD and second >= first]
            for path, lane in lanes.items()
        }
        elsewhere, self._elsewhere = self._elsewhere, 0
        told = {path: found for path, found in floods.items() if found}
        return Snapshot(messages, len(lanes), told, elsewhere)

    def _fits(self, raw: Raw) -> bool:
        return len(self._others.lanes) < self._room and len(raw.path) <= LONGEST_PATH

    def _forget(self) -> None:
        for pool in (self._known, self._others):
            pool.forget(self._newest - SECONDS)


def _size(raw: Raw) -> int:
    return OVERHEAD + len(raw.payload) + len(raw.attachment) + len(raw.encoding)
