"""Everything that is said of one robot, as it came: nothing is decoded, and nobody is held up."""

from collections.abc import Iterable, Iterator
from operator import attrgetter
from typing import NamedTuple

from zteleop.bus import clock
from zteleop.bus.presence import Publications
from zteleop.bus.session import Ring, Sample, Session
from zteleop.bus.topics import topic_of

DEPTH = 500
"""messages that wait on each path; a flood beyond it loses the oldest"""
MOST = 64
"""paths that are heard at once"""
LARGEST = 2**18
"""bytes of a message that is passed on"""
FLOOD, PAUSE = 150, 1.0
"""messages at once, after which a path is not heard for some s: each that is passed on costs the robot"""


class Raw(NamedTuple):
    """A message in its bytes."""

    at: float
    """when it came, or was taken where nobody took note of that, by the bus clock"""
    path: str
    """its key below the robot; the whole key where that has a wildcard"""
    encoding: str
    payload: bytes
    attachment: bytes
    deleted: bool
    """a delete, which is no message"""


class Tap:
    """Hears the `known` paths of a robot, and those on which a node has said that it publishes.

    It asks for nothing else: a stranger's flood passes nobody, as long as nobody hears it.
    """

    def __init__(self, session: Session, robot: str, known: Iterable[str]) -> None:
        self._session = session
        self._prefix = f"robot/{robot}/"
        self._inboxes: dict[str, Ring] = {}
        self._known = tuple(known)
        self._paused: dict[str, float] = {}
        for path in self._known:
            self._hear(path)
        self._publications = Publications(session, robot)

    def take(self) -> Iterator[Raw]:
        """Yield what has arrived, in its order, without waiting.

        Where nobody took note of that, what is commanded comes first: nobody says what he was commanded
        before the command has arrived. So who commands is asked last, too: else an effect that came between
        two looks would be told before its cause.
        """
        come, gone = self._publications.changes()
        new = come - self._inboxes.keys() - self._paused.keys()
        for path in sorted(new)[: MOST - len(self._inboxes)]:
            self._hear(path)
        now = clock.now()
        for path in [path for path, until in self._paused.items() if until <= now]:
            del self._paused[path]
            self._hear(path)
        heard = list(self._inboxes)
        said = [raw for path in heard if not _is_commanded(path) for raw in self._empty(path, now)]
        commanded = [raw for path in heard if _is_commanded(path) for raw in self._empty(path, now)]
        yield from sorted(commanded + said, key=attrgetter("at"))
        for path in gone.difference(self._known):  # their last words are taken
            self._paused.pop(path, None)
            self._leave(path)

    def _empty(self, path: str, now: float) -> Iterator[Raw]:
        """Yield what waits on a path; one that is flooded is left for a while."""
        taken, inbox = 0, self._inboxes[path]
        while taken < DEPTH and (sample := inbox.try_recv()) is not None:
            taken += 1
            key = sample.key
            if len(sample.payload) <= LARGEST:
                yield _raw(sample, key if "*" in key else key.removeprefix(self._prefix), now)
        if taken >= FLOOD:
            self._paused[path] = now + PAUSE
            self._leave(path)

    def _hear(self, path: str) -> None:
        key = self._prefix + path
        self._inboxes[path] = self._session.subscribe(key, DEPTH)

    def _leave(self, path: str) -> None:
        if inbox := self._inboxes.pop(path, None):
            inbox.undeclare()


def _is_commanded(path: str) -> bool:
    return path == "stop" or topic_of(path).command


def _raw(sample: Sample, path: str, now: float) -> Raw:
    at, attachment = sample.at or now, sample.attachment or b""
    return Raw(at, path, sample.encoding, sample.payload, attachment, not sample.is_put)
