"""A node that is on no bus: it remembers what was said, and hears what a test puts into its inboxes."""

from collections.abc import Callable, Iterable, Iterator
from types import SimpleNamespace
from typing import Any

from unit.bus.fakes import Clock

from zteleop.bus.loop import FAR
from zteleop.errors import DeviceError
from zteleop.messages import Beat, Message, Stop, Vehicle

Action = Callable[[], object]


class Said:
    """One publisher: what was said, and how often the operator acted."""

    def __init__(self, topic: str, sender: str = "") -> None:
        self.topic, self.sender = topic, sender
        self.messages: list[Any] = []
        self.acts = self.lets_go = 0
        self.matched = True
        self.refused = ""

    def act(self) -> None:
        self.acts += 1

    def let_go(self) -> None:
        self.lets_go += 1

    def repeat(self, message: Message) -> None:
        self.messages.append(message)

    def rest(self, message: Message) -> None:
        self.repeat(message)
        self.let_go()

    def publish(self, message: Message) -> None:
        self.act()
        self.repeat(message)

    def take(self) -> list[Any]:
        """Return what was said since the last look."""
        messages, self.messages = self.messages, []
        return messages


class Inbox:
    def __init__(self, handler: Callable[[Any], object] | None) -> None:
        self.handler = handler
        self.waiting: list[Any] = []

    def take(self) -> Iterator[Any]:
        while self.waiting:
            yield self.waiting.pop(0)

    def newest(self) -> Any:
        message = self.waiting[-1] if self.waiting else None
        self.waiting.clear()
        return message


class Node:
    def __init__(self, robot: str = "archangel") -> None:
        self.robot = robot
        self.said: dict[str, Said] = {}
        self.inboxes: dict[str, Inbox] = {}
        self.timers: dict[float, Action] = {}
        self._due: dict[float, float] = {}
        self.watched: dict[int, Action] = {}
        self.alarms: list[SimpleNamespace] = []
        self.robot_heard = SimpleNamespace(beat=None, vehicle=None, at=float("-inf"), refusals=None)
        self.stopped = False
        self.infos: list[str] = []
        self.warnings: list[str] = []
        self.errors: list[str] = []
        self.leaves: Callable[[int], object] = lambda sender: None
        self.log = SimpleNamespace(
            info=self.infos.append,
            warn=lambda text, subject="": self.warnings.append(text),
            error=lambda text, subject="": self.errors.append(text),
        )
        self.spin: Action = lambda: None

    def publisher(self, topic: str, types: object, *, source: str = "program", wait: bool = True) -> Said:
        return self.said.setdefault(topic, Said(f"{topic}/{source}", sender=f"{len(self.said) + 1:x}"))

    def subscription(
        self,
        topic: str,
        types: object,
        handler: Callable[[Any], object] | None = None,
        *,
        depth: int | None = None,
        complain: bool = True,
    ) -> Inbox:
        return self.inboxes.setdefault(topic, Inbox(handler))

    def departures(self, handler: Callable[[int], object]) -> None:
        self.leaves = handler

    def every(self, period: float) -> Callable[[Action], Action]:
        """Keep a timer under its period; two of the same period run one after the other."""

        def decorate(function: Action) -> Action:
            before = self.timers.get(period)
            self.timers[period] = (lambda: (before(), function())) if before else function
            return function

        return decorate

    def live(self, clock: Clock, seconds: float) -> None:
        """Let time pass, and run each timer, the first time at once, and each alarm when it is due."""
        end = clock.time + seconds
        while self.timers:
            for period, action in list(self.timers.items()):
                if self._due.get(period, clock.time) <= clock.time:
                    self._due[period] = self._due.get(period, clock.time) + period
                    action()
            self.ring(clock.time)
            due = min([*self._due.values(), *(alarm.due for alarm in self.alarms)])
            if due > end or self.stopped:
                break
            clock.time = max(clock.time, due)
        clock.time = end

    def alarm(self, action: Action) -> SimpleNamespace:
        self.alarms.append(SimpleNamespace(action=action, due=FAR))
        return self.alarms[-1]

    def ring(self, now: float) -> None:
        """Run the alarms that are due, as the loop does after what was called."""
        for alarm in self.alarms:
            if alarm.due <= now:
                alarm.due = FAR
                alarm.action()

    def watch(self, file: int, action: Action) -> None:
        self.watched[file] = action

    def unwatch(self, file: int) -> None:
        self.watched.pop(file, None)

    def heard(self) -> SimpleNamespace:
        return self.robot_heard

    def stop(self) -> None:
        self.stopped = True

    def hear(self, now: float, epoch: int = 1, vehicle: Vehicle | None = None) -> None:
        """Hear a beat of the robot, and perhaps what it says of itself."""
        self.robot_heard.beat, self.robot_heard.at = Beat(epoch, now, 0.0), now
        self.robot_heard.vehicle = vehicle or self.robot_heard.vehicle


class Chip:
    """A driver that keeps what it was told, and fails as often as a test says."""

    tick_us = 4.08

    def __init__(self, arming: float = 0.0) -> None:
        self.arming = arming
        self.pulses: dict[int, float | None] = {}
        self.writes: list[dict[int, float]] = []
        self.log: list[str] = []
        self.broken: set[str] = set()
        """Which of its methods fail."""

    def start(self, neutral_us: dict[int, float]) -> None:
        self._do("start", neutral_us)

    def write(self, pulse_us: dict[int, float]) -> None:
        self._do("write", pulse_us)

    def read(self, channels: Iterable[int]) -> dict[int, float | None]:
        self._do("read")
        return {channel: self.pulses.get(channel) for channel in channels}

    def check(self) -> None:
        self._do("check")

    def close(self) -> None:
        self.log.append("close")

    def _do(self, name: str, pulse_us: dict[int, float] | None = None) -> None:
        self.log.append(name)
        if name in self.broken:
            raise DeviceError(f"the chip does not take a {name}")
        if pulse_us:
            self.writes.append(pulse_us)
            self.pulses.update(pulse_us)


class Shelf:
    """A stop file without a file."""

    def __init__(self, *stops: Stop) -> None:
        self.stops = list(stops)
        self.past = 0
        self.unkept = ""
        self.full = self.stuck = False
        """Nothing more can be kept, or removed."""

    @property
    def stop(self) -> Stop | None:
        return self.stops[-1] if self.stops else None

    def exists(self) -> bool:
        return bool(self.stops)

    def load(self) -> list[Stop]:
        return list(self.stops)

    def ids(self) -> frozenset[int]:
        return frozenset(stop.id for stop in self.stops)

    def promise(self, stops: Iterable[Stop]) -> None:
        self.promised, self.unkept = list(stops), "they are being written"

    def keep(self, stops: Iterable[Stop]) -> None:
        self.promise(stops)
        self.tend()

    def tend(self) -> None:
        if self.unkept:
            self.stops = self.stops if self.full else self.promised
            self.unkept = "no space left" if self.full else ""

    def add(self, stop: Stop) -> None:
        self.keep([*self.stops, stop])

    def released(self) -> int:
        return self.past

    def release(self, said: Stop, rest: Iterable[Stop]) -> bool:
        self.stops = self.stops if self.stuck else list(rest)
        return not self.stuck

    def remove(self) -> None:
        """Do what somebody does by hand."""
        self.stops = []
