"""A node that is on no bus: it remembers what was said, and hears what a test puts into its inboxes."""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from zteleop.bus.loop import FAR
from zteleop.messages import Beat, Message, Vehicle

Action = Callable[[], object]


class Said:
    """One publisher: what was said, and how often the operator acted."""

    def __init__(self, topic: str, sender: str = "") -> None:
        self.topic, self.sender = topic, sender
        self.messages: list[Any] = []
        self.acts = 0

    def act(self) -> None:
        self.acts += 1

    def repeat(self, message: Message) -> None:
        self.messages.append(message)

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
        self.waiting: list[Message] = []

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
        self.watched: dict[int, Action] = {}
        self.alarms: list[SimpleNamespace] = []
        self.robot_heard = SimpleNamespace(beat=None, vehicle=None, at=float("-inf"))
        self.stopped = False
        self.infos: list[str] = []
        self.warnings: list[str] = []
        self.log = SimpleNamespace(
            info=self.infos.append, warn=lambda text, subject="": self.warnings.append(text)
        )
        self.spin: Action = lambda: None

    def publisher(self, topic: str, types: object, *, source: str = "program", wait: bool = True) -> Said:
        return self.said.setdefault(topic, Said(f"{topic}/{source}", sender=f"{len(self.said) + 1:x}"))

    def subscription(
        self, topic: str, types: object, handler: Callable[[Any], object] | None = None
    ) -> Inbox:
        return self.inboxes.setdefault(topic, Inbox(handler))

    def every(self, period: float) -> Callable[[Action], Action]:
        def decorate(function: Action) -> Action:
            self.timers[period] = function
            return function

        return decorate

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

    def heard(self) -> SimpleNamespace:
        return self.robot_heard

    def stop(self) -> None:
        self.stopped = True

    def hear(self, now: float, epoch: int = 1, vehicle: Vehicle | None = None) -> None:
        """Hear a beat of the robot, and perhaps what it says of itself."""
        self.robot_heard.beat, self.robot_heard.at = Beat(epoch, now), now
        self.robot_heard.vehicle = vehicle or self.robot_heard.vehicle
