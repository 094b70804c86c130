"""A node: a name on the bus, with publishers, subscriptions and timers, single-threaded for its user."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Self, TypeVar

from zteleop.bus import clock, codec, presence
from zteleop.bus.answer import Answer
from zteleop.bus.heard import Heard
from zteleop.bus.log import NodeLog
from zteleop.bus.loop import Loop, Timer
from zteleop.bus.names import Name, chunk, resolve, robot_name
from zteleop.bus.publisher import Publisher
from zteleop.bus.session import Delivery, Inbox, Outlet, Session, open_session
from zteleop.bus.settings import BusSettings
from zteleop.bus.subscription import Received, Subscription
from zteleop.bus.topics import topic_of
from zteleop.control.proof import Prover
from zteleop.errors import BusError, ConfigError
from zteleop.machine import signals, stderr
from zteleop.machine.ids import new_id
from zteleop.messages import Beat, Log, Message, Refusals, Vehicle

M = TypeVar("M", bound=Message)
T = TypeVar("T")
Types = type[M] | tuple[type[M], ...]
_GLANCE = 0.01


class Node:
    """Joins the bus for as long as its `with` lasts; handlers and timers run in `spin`."""

    def __init__(
        self,
        name: str,
        robot: str | None = None,
        bus: BusSettings | None = None,
        *,
        session: Session | None = None,
    ) -> None:
        self.name = chunk(name, "a node's name")
        self.robot = robot_name(robot) if robot else None
        self.session = session or open_session(bus or BusSettings())
        try:
            self._set_up()
        except BaseException:
            self.session.close()
            raise

    def _set_up(self) -> None:
        self._loop = Loop(before_each=self._listen)
        self._handles = self._closed = False
        self._deliveries: list[Delivery] = []
        self._heard: dict[str, Heard] = {}
        self._log_publisher: Publisher[Log] | None = None
        self.log = NodeLog(self.name, self._say, stderr.say)
        if self.robot:
            self._token(presence.node_key(self.robot, self.name))
            self._log_publisher = self.publisher("log", Log)

    def __enter__(self) -> Self:
        self._undo_signals = signals.unwind()
        return self

    def __exit__(self, *exc: object) -> None:
        try:
            self.close()
        finally:
            self._undo_signals()

    def close(self) -> None:
        """Leave the bus: others see this node go, and its threads end."""
        self._closed = True
        self.session.close()
        for delivery in self._deliveries:
            delivery.close()
        self._loop.close()
        stderr.flush()

    def publisher(
        self, topic: str, types: Types[M], *, source: str = "program", wait: bool = True
    ) -> Publisher[M]:
        """Return what says messages on a topic; on a command topic, as a source of that kind.

        For a command it first waits, at most 1 s, until the robot is heard, as its proofs echo the beats; and
        while the robot starts, at most 6 s.
        Raises ConfigError when the topic's name is none, or the topic takes other types.
        """
        name, kinds = resolve(topic, self.robot), _tuple(types)
        kind = topic_of(name.path)
        if kind.types and not set(kinds) <= set(kind.types):
            takes = " or ".join(accepted.__name__ for accepted in kind.types)
            raise ConfigError(f"{topic} takes {takes}, found {', '.join(k.__name__ for k in kinds)}")
        if not kind.command:
            return Publisher(self._declare(name, kinds, kind.urgent), kinds)
        path = name.path
        if path == kind.name:
            name = Name(name.robot, f"{kind.name}/{chunk(source, 'a source')}")
        heard = self.heard(name.robot)
        found = heard.wait() if wait else True
        sender = new_id()
        answer = Answer(f"{sender:x}", path, name.robot, heard, self.log)
        if not found:
            answer.miss()
        self._token(presence.sender_key(name.robot, sender))
        return Publisher(
            self._declare(name, kinds, kind.urgent),
            kinds,
            Prover(sender),
            heard,
            self._listen_now,
            answer,
        )

    def subscription(
        self,
        topic: str,
        types: Types[M],
        handler: Callable[[Received[M]], object] | None = None,
        *,
        depth: int | None = None,
        complain: bool = True,
    ) -> Subscription[M]:
        """Return an inbox of a topic; of a command topic, from all its sources.

        With a handler, `spin` hands it each message; without, iterate over the inbox. What is no
        message is dropped, counted, and said in the log unless somebody else does.
        """
        name, kinds = resolve(topic, self.robot), _tuple(types)
        kind = topic_of(name.path)
        if kind.command and name.path == kind.name:
            name = Name(name.robot, f"{kind.name}/**")
        depth = depth or kind.depth
        ring = self.session.subscribe(name.key, depth)
        self._token(presence.endpoint_key(name, "sub", self.name, kinds))
        inbox: Subscription[M] = Subscription(
            ring, codec.decoders(kinds), self._complain if complain else _keep_quiet, self._handling
        )
        if handler:
            self._deliver(inbox, handler)
        return inbox

    def departures(self, handler: Callable[[int], object]) -> None:
        """Hand each sender of commands that is gone, by its number, to a handler in `spin`."""
        self._deliver(presence.Departures(self.session, self._own_robot()), handler)

    def on(self, topic: str, types: Types[M]) -> Callable[[Callable[[M], object]], Callable[[M], object]]:
        """Decorate a function to handle each message of a topic in `spin`."""

        def decorate(function: Callable[[M], object]) -> Callable[[M], object]:
            self.subscription(topic, types, lambda received: function(received.message))
            return function

        return decorate

    def every(self, period: float) -> Callable[[Callable[[], object]], Callable[[], object]]:
        """Decorate a function to run every `period` seconds in `spin`."""
        if not period > 0:
            raise ConfigError(f"a timer's period must be more than 0 s, found {period}")

        def decorate(function: Callable[[], object]) -> Callable[[], object]:
            self._loop.every(period, function)
            return function

        return decorate

    def alarm(self, action: Callable[[], object]) -> Timer:
        """Return a timer that runs an action in `spin` once, whenever its `due` is set."""
        return self._loop.alarm(action)

    def watch(self, file: int, action: Callable[[], object]) -> None:
        """Run an action in `spin` whenever a file descriptor can be read."""
        self._loop.watch(file, action)

    def unwatch(self, file: int) -> None:
        self._loop.unwatch(file)

    def spin(self, seconds: float | None = None) -> None:
        """Run handlers and timers until `stop`, a signal, or for some seconds."""
        if self._closed:
            raise BusError(f"node {self.name} is closed; spin inside its `with`")
        with self._handling():
            self._loop.run(None if seconds is None else clock.now() + seconds)

    def until(self, look: Callable[[], T], seconds: float) -> T:
        """Spin until `look` finds something, at most for some seconds; return what it found last."""
        give_up = clock.now() + seconds
        while not (found := look()) and clock.now() < give_up:
            self.spin(_GLANCE)
        return found

    def stop(self) -> None:
        """End the present `spin`, or the next one; safe from any thread."""
        self._loop.stop()

    def heard(self, robot: str | None = None) -> Heard:
        """Return what is heard of a robot, by default the node's own."""
        robot = robot or self._own_robot()
        if robot not in self._heard:
            self._heard[robot] = Heard(
                self.subscription(f"/{robot}/beat", Beat),
                self.subscription(f"/{robot}/vehicle", Vehicle),
                self.subscription(f"/{robot}/refusals", Refusals, complain=False),
            )
        return self._heard[robot]

    def _own_robot(self) -> str:
        if self.robot is None:
            raise ConfigError(f"node {self.name} has no robot; say Node({self.name!r}, robot=...)")
        return self.robot

    def _declare(self, name: Name, kinds: tuple[type[Message], ...], urgent: bool) -> Outlet:
        self._token(presence.endpoint_key(name, "pub", self.name, kinds))
        return self.session.advertise(name.key, urgent)

    def _deliver(self, inbox: Inbox, handler: Callable[[Any], object]) -> None:
        self._deliveries.append(self.session.deliver(inbox, handler, self._loop))

    def _listen(self) -> None:
        for heard in self._heard.values():
            heard.listen()

    def _listen_now(self) -> None:
        """Listen on behalf of a publisher; in a handler what counts was heard before it began."""
        if not self._handles:
            self._listen()

    @contextmanager
    def _handling(self) -> Iterator[None]:
        """Let what is commanded meanwhile prove no more than what was heard before."""
        outer, self._handles = self._handles, True
        self._listen()
        try:
            yield
        finally:
            self._handles = outer

    def _token(self, key: str) -> None:
        self.session.declare_token(key)

    def _complain(self, text: str) -> None:
        self.log.warn(text, text.partition(":")[0])

    def _say(self, log: Log) -> None:
        if self._log_publisher:
            self._log_publisher.publish(log)


def _tuple(types: Types[M]) -> tuple[type[M], ...]:
    return types if isinstance(types, tuple) else (types,)


def _keep_quiet(text: str) -> None:
    """Leave it to somebody else to complain."""
