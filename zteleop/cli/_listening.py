"""Topics that a verb hears, each message at once, until the verb has enough or is told to end."""

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from typing import NamedTuple

from zteleop.bus import clock, presence
from zteleop.bus.escape import printable
from zteleop.bus.loop import Loop
from zteleop.bus.names import Name, resolve
from zteleop.bus.session import Delivery, Overheard, Ring, Sample, Session, open_session
from zteleop.bus.topics import topic_of
from zteleop.cli import _company, _options

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
        self._verb = verb
        self._session = session
        self._deliveries: list[Delivery] = []
        self._rings: dict[str, Overheard] = {}
        self._skipped: dict[str, int] = {}
        """of each topic, how much was told to be skipped"""
        self._silent: dict[str, Name] = {}
        """the topics that have said nothing yet, by their names"""
        self._heard: dict[str, tuple[Name, float]] = {}
        """those that have, and when"""
        self._look_at: dict[str, float] = {}
        """when to look whether anybody says them still"""

    def hear(self, name: Name, handler: Callable[[Arrival], object]) -> None:
        """Hand over whatever is said on a topic; of a command topic, by every source."""
        about = topic_of(name.path)
        key = f"{name.key}/**" if about.command and "/" not in name.path else name.key
        self._silent[str(name)] = name

        def take(arrival: Arrival) -> None:
            self._silent.pop(str(name), None)
            self._heard[str(name)] = name, arrival.at
            self._look_at[str(name)] = arrival.at + GONE_AFTER
            handler(arrival)

        ring = self._rings[str(name)] = self._session.overhear(key, DEPTH)
        inbox = _Inbox(ring)
        self._deliveries.append(self._session.deliver(inbox, take, self.loop))
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

    def _tell_skipped(self) -> None:
        """Tell what came faster than it could be taken in."""
        for name, ring in self._rings.items():
            more = ring.skipped - self._skipped.get(name, 0)
            if more:
                self._skipped[name] = ring.skipped
                words = f"skipped {more} messages on {name}, which came faster than they were taken in"
                print(printable(f"zteleop {self._verb}: {words}"), file=sys.stderr, flush=True)

    def _notice_end(self) -> None:
        """Tell, once, of a topic that nobody says any more: what it said last is no longer so."""
        now = clock.now()
        silent = [(name, at) for key, (name, at) in self._heard.items() if now > self._look_at[key]]
        endpoints = self.endpoints() if silent else []
        for name, at in silent:
            self._look_at[str(name)] = now + LOOK_AGAIN
            if not _company.members(name, "pub", endpoints):
                words = f"{name} has been silent for {now - at:.0f} s, and nobody publishes it any more"
                print(printable(f"zteleop {self._verb}: {words}"), file=sys.stderr, flush=True)
                del self._heard[str(name)]

    def _tell(self) -> None:
        for name in list(self._silent.values()):
            words = f"zteleop {self._verb}: waits for {self.why_silent(name)}"
            print(words, file=sys.stderr, flush=True)


class _Inbox:
    def __init__(self, ring: Ring) -> None:
        self.ring = ring

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
    robots = [_options.robot_of(topic, settings) for topic in topics]
    with ExitStack() as afterwards, open_session(settings.bus, settle=settle or None in robots) as session:
        selected = _options.find_robot(session, settings) if None in robots else None
        ears = Listening(verb, session)
        afterwards.callback(ears.close)
        yield ears, [resolve(topic, robot or selected) for topic, robot in zip(topics, robots, strict=True)]
