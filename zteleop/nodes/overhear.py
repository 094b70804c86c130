"""What the watchdog hears for itself: commands, stops, and whether the actuator is on the bus at all."""

from zteleop.bus.node import Node
from zteleop.bus.subscription import Subscription
from zteleop.bus.topics import TOPICS
from zteleop.control.command import to_command
from zteleop.control.drive import DriveSettings
from zteleop.control.judge import GRACE, Judge
from zteleop.control.stop import Latch
from zteleop.errors import MessageError
from zteleop.messages import Beat, Stop
from zteleop.nodes.stop_file import StopFile

DEAF_AFTER = 0.5
"""s without a beat of the actuator's epoch."""
DEPTH = 500
"""Commands kept of each source for one tick; a flood beyond it loses the oldest."""


class Overhearing:
    """Tells the judge what is said, in the watchdog's own time: nothing here wakes it."""

    def __init__(self, node: Node, settings: DriveSettings, judge: Judge, stop_file: StopFile) -> None:
        self._judge, self._stop_file = judge, stop_file
        self._commands = [
            node.subscription(f"{topic}/{source}", TOPICS[topic].types, depth=DEPTH, complain=False)
            for source in settings.known_sources
            for topic in ("cmd_vel", "pwm")
        ]
        self._beats = node.subscription("beat", Beat, complain=False)
        self._stops: Subscription[Stop] = node.subscription("stop", Stop, complain=False)
        self._latch = Latch()
        self._asked_at = float("-inf")
        self._told = self._was_kept = False
        self._beat_at = float("-inf")
        self.commands = 0

    def listen(self, now: float) -> Stop | None:
        """Take in what was said; return a stop that the actuator should have kept by now, and has not."""
        for inbox in self._commands:
            for received in inbox.take():
                self.commands += 1
                try:
                    command = to_command(received.message)
                except MessageError:
                    continue  # the actuator says so
                self._judge.receive(received.source, command, received.proof, received.at)
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
    def stop(self) -> Stop | None:
        """The stop in force, as far as it was heard."""
        return self._latch.stop

    def engage(self, stop: Stop, now: float) -> None:
        """Learn of a stop that the watchdog itself engages."""
        self._latch.obey(stop)
        self._asked_at, self._told = now, True

    def _listen_for_stops(self, now: float) -> Stop | None:
        for received in self._stops.take():
            if self._latch.obey(received.message):
                self._asked_at, self._told = now, False
                if not received.message.engaged:
                    self._judge.hear_release(now)
        kept = self._stop_file.exists()
        if self._was_kept and not kept and self._asked_at != now:
            self._latch.forget()  # whoever removed the file has released it
        self._was_kept = kept
        stop = self._latch.stop
        self._judge.rest(kept or stop is not None, now)
        if stop is None or kept or self._told or now - self._asked_at <= GRACE:
            return None
        self._told = True
        return stop
