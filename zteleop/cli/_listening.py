"""Topics that a verb hears, each message at once, until the verb has enough or is told to end."""

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

from msgspec import Struct

from zteleop.bus import clock, presence
from zteleop.bus.escape import printable
from zteleop.bus.lag import Lag
from zteleop.bus.loop import FAR, Loop
from zteleop.bus.names import Name, resolve
from zteleop.bus.session import Delivery, Overheard, Ring, Sample, Session, open_session
from zteleop.bus.topics import topic_of
from zteleop.cli import _company, _options
from zteleop.control.proof import NEVER
from zteleop.errors import BusError

if TYPE_CHECKING:
    from zteleop.cli._history import History

DEPTH = 1000
"""messages that wait for whoever looks at them; of a flood the oldest are lost"""
MOST_COMPLAINTS = 100
"""of one run; a flood of nonsense has no more to say"""
GONE_AFTER = 2.0
"""s of silence after which it looks whether anybody says something still"""
LOOK_AGAIN = 10.0
"""s until it looks once more, where somebody is there who only pauses"""
TELL_SKIPPED_EVERY = 2.0
"""s"""
TELL_AFTER = 1.0
"""s of silence at the start until it says for whom it waits"""


class Arrival(NamedTuple):
    """A message in its bytes, and when it was taken, by the bus clock."""

    at: float
    sample: Sample


class Topic(Struct):
    """One that is heard."""

    name: Name
    ring: Overheard
    heard: float = NEVER
    look_at: float = FAR
    """when to look whether anybody says it still"""
    skipped: int = 0
    """how much was told to be skipped"""


class Complaints:
    """Tells each sentence once, however often there is reason for it."""

    def __init__(self) -> None:
        self._told: set[str] = set()

    def tell(self, words: str) -> None:
        """Tell it on stderr, if it is new; of many that differ only the first."""
        if words not in self._told and len(self._told) < MOST_COMPLAINTS:
            self._told.add(words)
            print(printable(words), file=sys.stderr, flush=True)


class Listening:
    """A verb's ears: handlers run one after another in `loop`, which `run` runs until it is stopped."""

    def __init__(self, verb: str, session: Session) -> None:
        self.loop = Loop(lambda: None)
        self.patient = True
        """Says after a while for whom it waits."""
        self.told = False
        """It has said so."""
        self._verb = verb
        self._session = session
        self._deliveries: list[Delivery] = []
        self._topics: list[Topic] = []

    def hear(self, name: Name, handler: Callable[[Arrival], object], since: float | None = None) -> None:
        """Hand over whatever is said on a topic, and was in the last `since` s.

        Of a command topic, by every source.
        """
        about = topic_of(name.path)
        key = f"{name.key}/**" if about.command and "/" not in name.path else name.key
        topic = Topic(name, self._session.overhear(key, DEPTH))
        self._topics.append(topic)
        history = self._recall(name, handler, since) if since else None

        def take(arrival: Arrival) -> None:
            topic.heard = arrival.at
            topic.look_at = arrival.at + GONE_AFTER
            if not (history and history.holds(arrival.sample, arrival.at)):
                handler(arrival)

        self._deliveries.append(self._session.deliver(_Inbox(topic.ring), take, self.loop))
        self._session.declare_token(presence.endpoint_key(name, "sub", self._verb, about.types))

    def run(self) -> None:
        """Hear until the loop is stopped."""
        self.loop.every(TELL_SKIPPED_EVERY, self._tell_skipped)
        if self.patient:
            self.loop.alarm(self._tell).ring_at(clock.now() + TELL_AFTER)
            self.loop.every(GONE_AFTER, self._notice_end)
        self.loop.run()

    def endpoints(self) -> list[presence.Endpoint]:
        """Return what every robot's nodes publish and hear now."""
        return presence.endpoints(self._session)

    def unreached(self) -> Sequence[str]:
        """Return the endpoints at which nobody answers, where nobody does at any."""
        return self._session.unreached()

    def why_silent(self, name: Name) -> str:
        """Return who says nothing on a topic, or which topic may have been meant."""
        words = _company.why_silent(name, self.endpoints(), self._session.unreached())
        return printable(f"{name}: {words}")

    def close(self) -> None:
        """Hear no more; the session must be closed first."""
        for delivery in self._deliveries:
            delivery.close()
        self.loop.close()

    def _recall(self, name: Name, handler: Callable[[Arrival], object], since: float) -> "History | None":
        """Hand over what was said, in the loop's first round; where nobody knows it, say so."""
        from zteleop.cli._history import History  # which only few ask for

        try:
            history = History(self._session, name, since)
        except BusError as error:
            self._say(f"no history: {error}")
            return None
        for sample in history.samples:
            self.loop.call_soon(partial(handler, Arrival(clock.now(), sample)))
        return history

    def _tell_skipped(self) -> None:
        """Tell what came faster than it could be taken in."""
        for topic in self._topics:
            if more := topic.ring.skipped - topic.skipped:
                topic.skipped = topic.ring.skipped
                self._say(
                    f"skipped {more} messages on {topic.name}, which came faster than they were taken in"
                )

    def _notice_end(self) -> None:
        """Tell, once, of a topic that nobody says any more: what it said last is no longer so."""
        now = clock.now()
        silent = [topic for topic in self._topics if now > topic.look_at]
        endpoints = self.endpoints() if silent else []
        for topic in silent:
            ended = not _company.members(topic.name, "pub", endpoints)
            topic.look_at = FAR if ended else now + LOOK_AGAIN
            if ended:
                gone = f"has been silent for {now - topic.heard:.0f} s, and nobody publishes it any more"
                self._say(f"{topic.name} {gone}")

    def _tell(self) -> None:
        for topic in self._topics:
            if topic.heard == NEVER:
                self.told = True
                self._say(f"waits for {self.why_silent(topic.name)}")

    def _say(self, words: str) -> None:
        print(printable(f"zteleop {self._verb}: {words}"), file=sys.stderr, flush=True)


class _Inbox:
    def __init__(self, ring: Ring) -> None:
        self.ring = ring
        self.lag = Lag()

    def read(self, sample: Sample) -> Arrival | None:
        return Arrival(clock.now(), sample) if sample.is_put else None


@contextmanager
def listening(
    verb: str, topics: Sequence[str], arguments: argparse.Namespace, settle: bool = False
) -> Iterator[tuple[Listening, list[Name]]]:
    """Join the bus to hear topics; yield the ears, and the topics' names in the order typed.

    With `settle`, once everybody is found.

    Raises ConfigError for a name that is none, or could be several robots'.
    """
    settings = _options.load(arguments)
    robots = [_options.robot_of(topic, settings, arguments.robot) for topic in topics]
    with ExitStack() as afterwards, open_session(settings.bus, settle=settle or None in robots) as session:
        selected = _options.find_robot(session, settings) if None in robots else None
        ears = Listening(verb, session)
        afterwards.callback(ears.close)
        yield ears, [resolve(topic, robot or selected) for topic, robot in zip(topics, robots, strict=True)]
