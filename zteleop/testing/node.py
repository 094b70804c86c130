"""A node that is on no bus: it remembers what was said, and hears what a test says to it."""

from collections.abc import Callable, Iterator, Sequence
from types import SimpleNamespace
from typing import Any, Self

from zteleop.bus.heard import Heard
from zteleop.bus.parameters import Bounds, Declared
from zteleop.errors import BusError
from zteleop.messages import Beat, Message, Vehicle
from zteleop.testing.clock import Clock
from zteleop.testing.link import Link
from zteleop.testing.loop import Action, FakeLoop

GLANCE = 0.01


class Said:
    """A publisher that keeps what was said, and how often the operator acted or let go."""

    def __init__(self, topic: str, sender: str = "") -> None:
        self.topic = topic
        self.sender = sender
        self.messages: list[Any] = []
        self.acts = 0
        self.lets_go = 0
        self.matched = True
        self.refused = ""
        """Why the robot does not obey it, for a test to say."""

    def act(self) -> None:
        self.acts += 1

    def let_go(self) -> None:
        self.lets_go += 1

    def publish(self, message: Message) -> None:
        self.act()
        self.repeat(message)

    def repeat(self, message: Message) -> None:
        self.messages.append(message)

    def rest(self, message: Message) -> None:
        self.repeat(message)
        self.let_go()

    def take(self) -> list[Any]:
        """Return what was said since the last look."""
        messages = self.messages
        self.messages = []
        return messages


class Inbox:
    """A subscription into which a test puts messages; what iterates over it ends when it is empty."""

    def __init__(self, *handlers: Callable[[Any], object]) -> None:
        self.handlers = list(handlers)
        self.waiting: list[Any] = []
        self.dropped = 0

    def handler(self, received: Any) -> None:
        """Hand something to every handler."""
        for handle in self.handlers:
            handle(received)

    def __iter__(self) -> Iterator[Any]:
        return self.take()

    def take(self) -> Iterator[Any]:
        while self.waiting:
            yield self.waiting.pop(0)

    def newest(self) -> Any:
        message = self.waiting[-1] if self.waiting else None
        self.waiting.clear()
        return message


class Robot(Heard):
    """What is heard of a robot, as a test has it: nobody else says anything."""

    def __init__(self) -> None:
        nobody: Any = Inbox()
        super().__init__(nobody, nobody, nobody)

    def wait(self, tell: Callable[[], object]) -> bool:
        return self.there


class FakeMembership:
    """What a fake node is made of."""

    def __init__(self, loop: FakeLoop) -> None:
        self.loop = loop
        self.session: Any = SimpleNamespace(tokens=lambda selector: set(), unreached=lambda: ())
        self.robot = Robot()
        self.leaves: Callable[[int], object] = lambda sender: None
        """What is done when a sender of commands is gone."""

    def heard(self, robot: str | None = None) -> Robot:
        return self.robot

    def departures(self, handler: Callable[[int], object]) -> None:
        self.leaves = handler

    def until(self, look: Callable[[], Any], seconds: float) -> Any:
        give_up = self.loop.clock.time + seconds
        while not (found := look()) and self.loop.clock.time < give_up:
            self.loop.live(GLANCE)
        return found


class FakeNode:
    """A `Node` to hand to a program under test; its log is three lists of sentences.

    It checks neither types nor names, and `await_robot` finds its robot at once. What is said on one topic is
    kept together, whoever says it. Once it was stopped its timers run no more.
    """

    def __init__(
        self,
        name: str = "program",
        robot: str | None = "archangel",
        *,
        clock: Clock | None = None,
        link: Link[Any] | None = None,
    ) -> None:
        self.name = name
        self.robot = robot
        self.said: dict[str, Said] = {}
        """By topic, what was published."""
        self.inboxes: dict[str, Inbox] = {}
        """By topic, what is subscribed to."""
        self.services: dict[str, Callable[[Any], Message]] = {}
        """By name, who answers."""
        self.parameters: dict[str, Declared[Any]] = {}
        self.infos: list[str] = []
        self.warnings: list[str] = []
        self.errors: list[str] = []
        self.log = SimpleNamespace(
            debug=lambda text: None,
            info=self.infos.append,
            warn=lambda text, subject="": self.warnings.append(text),
            error=lambda text, subject="": self.errors.append(text),
        )
        self.loop = FakeLoop(clock or Clock())
        self.membership = FakeMembership(self.loop)
        self._link: Link[Any] = link or Link()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()

    def close(self) -> None:
        self.stop()

    def await_robot(self) -> bool:
        return True

    def publisher(
        self, topic: str, types: object, *queue: object, source: str = "program", wait: bool = True
    ) -> Said:
        return self.said.setdefault(topic, Said(f"{topic}/{source}", sender=f"{len(self.said) + 1:x}"))

    def subscription(
        self,
        topic: str,
        types: object,
        handler: Callable[[Any], object] | None = None,
        depth: int | None = None,
        *,
        complain: bool = True,
    ) -> Inbox:
        inbox = self.inboxes.setdefault(topic, Inbox())
        inbox.handlers += [handler] if handler else []
        return inbox

    def on(
        self,
        topic: str,
        types: object,
        function: Callable[[Any], object] | None = None,
        *,
        depth: int | None = None,
    ) -> Callable[[Callable[[Any], object]], Callable[[Any], object]]:
        def decorate(function: Callable[[Any], object]) -> Callable[[Any], object]:
            self.subscription(topic, types, lambda received: function(received.message), depth=depth)
            return function

        if function:
            decorate(function)
        return decorate

    def service(
        self,
        name: str,
        request: type[Message],
        response: type[Message],
        handler: Callable[[Any], Message],
    ) -> None:
        self.services[name] = handler

    def call(self, name: str, request: Message, response: type[Message], seconds: float = 2.0) -> Any:
        """Ask a service that this node has, or that a test has put in its place."""
        if name not in self.services:
            raise BusError(f"nobody serves {name}")
        return self.services[name](request)

    def parameter(
        self,
        name: str,
        value: Any,
        description: str = "",
        *,
        least: float | None = None,
        most: float | None = None,
        choices: Sequence[str] = (),
        changed: Callable[[Any], object] | None = None,
    ) -> Declared[Any]:
        """Return a parameter; a test changes it by its `set`."""
        declared = Declared(name, value, description, Bounds(least, most, choices), changed)
        self.parameters[name] = declared
        return declared

    def every(self, period: float, function: Action | None = None) -> Callable[[Action], Action]:
        def decorate(function: Action) -> Action:
            self.loop.every(period, function)
            return function

        if function:
            decorate(function)
        return decorate

    def spin(self, seconds: float | None = None) -> None:
        """Let time pass; without an end, none does: say what is to happen with `hear` and `live`."""
        if seconds is not None:
            self.live(seconds)

    def stop(self) -> None:
        self.loop.stop()

    @property
    def stopped(self) -> bool:
        """It was told to stop."""
        return self.loop.stopped

    def live(self, seconds: float) -> None:
        """Let so many seconds pass at once: timers run when they are due, until the node is stopped."""
        self.loop.live(seconds)

    def hear(self, topic: str, message: Message) -> None:
        """Hear a message, by way of the link: its handler runs now, or it waits in its inbox."""
        inbox = self.inboxes[topic]
        for arrived in self._link.carry(message):
            if inbox.handlers:
                inbox.handler(SimpleNamespace(message=arrived, at=self.loop.clock.time))
            else:
                inbox.waiting.append(arrived)

    def hear_beat(self, epoch: int = 1, vehicle: Vehicle | None = None) -> None:
        """Hear the robot's beat, and perhaps what it says of itself."""
        robot = self.membership.robot
        robot.beat = Beat(epoch, self.loop.clock.time, 0.0)
        robot.at = self.loop.clock.time
        robot.vehicle = vehicle or robot.vehicle
