"""What the watchdog hears for itself: commands, stops, and whether the actuator is on the bus at all."""

from zteleop.bus.node import Node
from zteleop.bus.subscription import Subscription
from zteleop.bus.topics import TOPICS
from zteleop.control.command import to_command
from zteleop.control.deadlines import DEAF_AFTER, GRACE
from zteleop.control.judge import Judge
from zteleop.control.settings import DriveSettings
from zteleop.control.stop import MERGED, Latch
from zteleop.errors import MessageError
from zteleop.machine.stop_file import UNREADABLE, StopFile
from zteleop.messages import Beat, Stop

DEPTH = 500
"""Commands kept of each source for one tick; a flood beyond it loses the oldest."""


MANY = 50
"""commands between two looks"""


class Overhearing:
    """Tells the judge what is said, in the watchdog's own time: nothing here wakes it."""

    def __init__(self, node: Node, settings: DriveSettings, judge: Judge, stop_file: StopFile) -> None:
        self._judge = judge
        self._stop_file = stop_file
        self._commands = [
            node.subscription(f"{topic}/{source}", TOPICS[topic].types, depth=DEPTH, complain=False)
            for source in settings.known_sources
            for topic in ("cmd_vel", "pwm")
        ]
        self._beats = node.subscription("beat", Beat, complain=False)
        self._stops: Subscription[Stop] = node.subscription("stop", Stop, complain=False)
        self._latch = Latch(stop_file.load())
        self._kept = stop_file.ids()
        self._asked: dict[int, float] = {}
        """When a stop was heard that the actuator must keep, by its id."""
        self._beat_at = float("-inf")
        self.commands = 0
        self.floods = False
        """More came since the look before than people and programs say: the next must come soon."""

    def listen(self, now: float) -> Stop | None:
        """Take in what was said; return a stop that the actuator should have kept by now, and has not."""
        before = self.commands
        for inbox in self._commands:
            for received in inbox.take():
                self.commands += 1
                try:
                    command = to_command(received.message)
                except MessageError:
                    continue  # the actuator says so
                self._judge.receive(received.source, command, received.proof, received.at)
        self.floods = self.commands - before > MANY
        return self._listen_for_stops(now)

    def hears(self, epoch: int | None, now: float) -> bool:
        """Say whether the actuator's beats arrive, and with them everything else."""
        if any(received.message.epoch == epoch for received in self._beats.take()):
            self._beat_at = now
        return now - self._beat_at < DEAF_AFTER

    def forget_beats(self) -> None:
        """Hear another actuator only by beats of its own."""
        self._beat_at = float("-inf")
        for _ in self._beats.take():
            pass

    @property
    def stops(self) -> tuple[Stop, ...]:
        """The stops in force, as far as they were heard."""
        return self._latch.stops

    def hear_stop(self, stop: Stop, now: float) -> bool:
        """Learn of a stop that came without zenoh, and that the actuator must keep; True when it is news."""
        is_news = self._latch.obey(stop)
        if is_news:
            self._asked[stop.id] = now
        return is_news

    def holds(self, stop: Stop) -> bool:
        """Say whether a stop is in force, by itself or by what has taken its place."""
        return any(kept.id in (stop.id, MERGED.id) or kept.by == stop.by for kept in self._latch.stops)

    def keeps(self, stop: Stop) -> bool:
        """Say whether a file holds it, or what has taken its place, so that it outlives a restart."""
        return not self._kept.isdisjoint((stop.id, MERGED.id, UNREADABLE))

    def engage(self, stop: Stop) -> None:
        """Learn of a stop that the watchdog itself engages."""
        self._latch.obey(stop)
        self._asked.pop(stop.id, None)

    def _listen_for_stops(self, now: float) -> Stop | None:
        for received in self._stops.take():
            if self._latch.obey(received.message):
                if received.message.engaged:
                    self._asked[received.message.id] = now
                else:
                    self._judge.hear_release(now)
        self._compare(self._stop_file.ids(), now)
        self._judge.rest(bool(self._kept or self._latch.stops), now)
        return self._find_ignored(now)

    def _compare(self, kept: frozenset[int], now: float) -> None:
        """Forget what was in the file and no longer is: whoever took it out has released it."""
        gone = {identity for identity in self._kept - kept if self._asked.get(identity) != now}
        if UNREADABLE in kept:  # perhaps it is only being written
            self._kept |= kept
        else:
            self._latch.forget(gone)
            self._kept = kept

    def _find_ignored(self, now: float) -> Stop | None:
        """Return a stop that is in force, and for long in no file; once."""
        if not self._asked or UNREADABLE in self._kept:
            return None
        in_force = {stop.id: stop for stop in self._latch.stops}
        for identity, at in list(self._asked.items()):
            if identity in self._kept or identity not in in_force:
                del self._asked[identity]
            elif now - at > GRACE:
                del self._asked[identity]
                return in_force[identity]
        return None
