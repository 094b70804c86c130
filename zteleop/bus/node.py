"""A node: a name on the bus, with publishers, subscriptions and timers, single-threaded for its user."""

import atexit
import os
import sys
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Self, TypeVar

from zteleop.bus import presence, rclpy_names, times
from zteleop.bus.commands import Commands
from zteleop.bus.hearers import Hearers
from zteleop.bus.log import LEVELS, NodeLog
from zteleop.bus.membership import Membership
from zteleop.bus.names import Name, as_typed, chunk, known_as, resolve, robot_name
from zteleop.bus.parameters import Bounds, Declared, Parameters
from zteleop.bus.publisher import Publisher
from zteleop.bus.service import ANSWERED_WITHIN, Services, call
from zteleop.bus.session import Session, open_session
from zteleop.bus.settings import BusSettings
from zteleop.bus.speakers import Speakers
from zteleop.bus.subscription import Received, Subscription
from zteleop.bus.topics import topic_of
from zteleop.bus.types import SERVICE, OwnTypes, Types, kinds_of
from zteleop.errors import ConfigError
from zteleop.interfaces.parameters import Value
from zteleop.machine import signals, stderr
from zteleop.messages import GetTypeRequest, GetTypeResponse, Log, Message, service_type

M = TypeVar("M", bound=Message)
Q = TypeVar("Q", bound=Message)
R = TypeVar("R", bound=Message)
V = TypeVar("V", bound=Value)

PROGRAM = "program"
"""what a publisher of commands is, unless it says which input"""
READS_NO_FILE = "; where it is, a program says by bus=BusSettings(connect=[...]): it reads no config.toml"


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
        self._waits_for_spin = ""  # what a program that never spins does in vain
        self.name = chunk(name, "a node's name")
        self.robot = robot_name(robot) if robot else None
        hint = "" if bus or session else READS_NO_FILE
        session = session or open_session(bus or BusSettings())
        try:
            # the insides, for whoever needs the session, the loop, or what is heard of robots
            self.membership = Membership(self.name, self.robot, session, self._complain)
            self._services = Services(session, self.name, self.membership.loop, self._complain)
            self.log = NodeLog(self.name, self._say, stderr.tell)
            self._commands = Commands(self.name, self.membership, self.log, hint)
            self._log_publisher: Publisher[Log] | None = None
            self._parameters = Parameters(self.log.info)
            self._types = OwnTypes(self._serve_types)
            if self.robot:
                session.declare_token(presence.node_key(self.robot, self.name))
                self._log_publisher = self.publisher("log", Log)
                self._serve_parameters(self.robot)
        except BaseException:
            session.close()
            raise
        atexit.register(self._end_with_program, os.getpid())

    def __enter__(self) -> Self:
        self._undo_signals = signals.unwind()
        return self

    def __exit__(self, error: type[BaseException] | None, *exc: object) -> None:
        try:
            self._leave(failed=error is not None)
        finally:
            self._undo_signals()

    def _end_with_program(self, process: int) -> None:
        """Leave in order, as a program ends that has no `with`; not as a copy of it does."""
        if os.getpid() == process:
            self._leave(failed=hasattr(sys, "last_value"))

    def _leave(self, failed: bool) -> None:
        if self._waits_for_spin and not failed and not self.membership.has_spun:
            self.log.warn(f"{self._waits_for_spin}: node.spin() runs what waits, and was not called")
        self.close()

    def close(self) -> None:
        """Let go of every robot and leave the bus: others see this node go, and its threads end."""
        atexit.unregister(self._end_with_program)
        self._waits_for_spin = ""
        try:
            self._commands.leave()
        finally:
            self.membership.close()
            stderr.flush()

    def await_robot(self) -> bool:
        """Wait, at most 10 s, until the robot is heard, and 6 s more while it starts; True when it is there.

        What moves before that has begun too early to drive it. A publisher of commands waits likewise.
        """
        return self._commands.await_robot(self.membership.own_robot())

    def publisher(
        self, topic: str, types: Types[M], *queue: object, source: str = PROGRAM, wait: bool = True
    ) -> Publisher[M]:
        """Return what says messages on a topic; on a command topic, as a source of that kind.

        For a command it first waits for the robot, as `await_robot` does, unless told not to.
        Raises ConfigError when the topic's name is none, or the topic takes other types; and for the
        length of a queue, which rclpy wants and nobody keeps here.
        """
        name = resolve(topic, self.robot)
        if queue:
            found = ", ".join(map(repr, queue))
            raise ConfigError(
                f"publisher(topic, type) keeps no queue, found {found:.40}: who hears says depth=, "
                "in node.subscription or node.on"
            )
        kinds = kinds_of(types)
        about = topic_of(name.path)
        if about.types and not set(kinds) <= set(about.types):
            takes = " or ".join(accepted.__name__ for accepted in about.types)
            raise ConfigError(f"{topic} takes {takes}, found {', '.join(k.__name__ for k in kinds)}")
        self._notice_typo(topic, "publishes {}, which no robot hears")
        self._types.add(name.robot, kinds)
        if not about.types:  # a topic of somebody's own, which anybody may take for another
            Hearers(self.membership.session, name, kinds, self.log.warn).watch(self.membership.loop)
        if not about.command:
            return Publisher(self.membership.outlet(name, kinds, about.urgent), kinds)
        if name.path == about.name:
            name = Name(name.robot, f"{about.name}/{chunk(source, 'a source')}")
        return self._commands.publisher(name, kinds, source, wait, as_typed(topic, name.robot))

    def _notice_typo(self, topic: str, words: str) -> None:
        """Ask whoever names a topic that is nearly a known one."""
        if near := self._meant(topic):
            self.log.warn(f"{words.format(topic)}; did you mean {near}?")

    def _meant(self, topic: str) -> str:
        """Return the known topic that a name nearly is; nothing where the robot's stands there as well."""
        name = resolve(topic, self.robot)
        is_meant = topic_of(name.path).types or topic.startswith(f"/{name.robot}/")
        return "" if is_meant else known_as(name.path)

    def subscription(
        self,
        topic: str,
        types: Types[M],
        handler: Callable[[Received[M]], object] | None = None,
        depth: int | None = None,
        *,
        complain: bool = True,
    ) -> Subscription[M]:
        """Return an inbox of a topic; of a command topic, from all its sources.

        With a handler, `spin` hands it each message; without, iterate over the inbox. What is no
        message is dropped, counted, and said in the log unless somebody else does.
        """
        self._notice_typo(topic, "hears {}, which no robot says")
        self._types.add(resolve(topic, self.robot).robot, kinds_of(types))
        inbox: Subscription[M] = self.membership.inbox(topic, kinds_of(types), depth, complain)
        if handler:
            self._waits_for_spin = f"nothing of {topic} was handled"
            self.membership.deliver(inbox, handler)
        else:
            inbox.on_wait = lambda: self._miss_speakers(resolve(topic, self.robot), in_loop=False)
        return inbox

    def on(
        self,
        topic: str,
        types: Types[M],
        function: Callable[[M], object] | None = None,
        *,
        depth: int | None = None,
    ) -> Callable[[Callable[[M], object]], Callable[[M], object]]:
        """Decorate a function to handle each message of a topic in `spin`; of one nobody says, it tells.

        A function that is given is decorated at once.
        """

        def decorate(function: Callable[[M], object]) -> Callable[[M], object]:
            self.subscription(topic, types, lambda received: function(received.message), depth=depth)
            if not self._meant(topic):  # else that is told
                self._miss_speakers(resolve(topic, self.robot))
            return function

        if function is not None:
            rclpy_names.expect_function(function)
            decorate(function)
        return decorate

    def _miss_speakers(self, name: Name, in_loop: bool = True) -> None:
        """Tell whoever waits for a topic that nobody publishes it; of commands there may be none for long."""
        if not topic_of(name.path).command:
            speakers = Speakers(self.membership.session, name, self.log.warn, self.log.info)
            if in_loop:
                speakers.watch(self.membership.loop)
            else:
                self.membership.beside(speakers.look)

    def service(self, name: str, request: type[Q], response: type[R], handler: Callable[[Q], R]) -> None:
        """Answer what others ask under a name, in `spin`; a handler that raises is told to whoever asked.

        Raises ConfigError for types that are not of one service.
        """
        self._services.add(resolve(name, self.robot), request, response, handler)

    def call(self, name: str, request: Message, response: type[R], seconds: float = ANSWERED_WITHIN) -> R:
        """Ask a service, and wait for its answer: not in a handler that drives.

        Raises BusError when nobody answers within some seconds, or it is refused.
        """
        return call(self.membership.session, resolve(name, self.robot), request, response, seconds)

    def parameter(
        self,
        name: str,
        value: V,
        description: str = "",
        *,
        least: float | None = None,
        most: float | None = None,
        choices: Sequence[str] = (),
        changed: Callable[[V], object] | None = None,
    ) -> Declared[V]:
        """Return a parameter, whose `value` others change while the node spins, within these bounds.

        `changed` hears of another value before it counts, and refuses it by raising a ValueError.
        Raises ConfigError when the name is none or is taken, or the value is out of bounds.
        """
        bounds = Bounds(least, most, choices)
        return self._parameters.declare(name, value, description, bounds, changed)

    def _serve_parameters(self, robot: str) -> None:
        """Let others see and change this node's parameters; each has one at least."""
        self.parameter(
            "log_level",
            "info",
            "what is worth telling, on the bus and on stderr",
            choices=tuple(LEVELS),
            changed=self.log.tell_from,
        )

        def serve(
            name: str, request: type[Message], response: type[Message], handler: Callable[[Any], Message]
        ) -> None:
            name_of = Name(robot, f"{self.name}/{name}")
            self._services.add(name_of, request, response, handler, stands=False)

        self._parameters.serve(serve)
        name = Name(robot, f"{self.name}/{times.SERVICE}")
        self._services.add(name, *service_type(times.TYPE), times.tell, stands=False, at_once=True)
        self.membership.session.declare_token(presence.parameters_key(robot, self.name))

    def _serve_types(self, robot: str, tell: Callable[[GetTypeRequest], GetTypeResponse]) -> None:
        name = Name(robot, f"{self.name}/{SERVICE}")
        self._services.add(name, GetTypeRequest, GetTypeResponse, tell, stands=False, at_once=True)

    def every(
        self, period: float, function: Callable[[], object] | None = None
    ) -> Callable[[Callable[[], object]], Callable[[], object]]:
        """Decorate a function to run every `period` seconds in `spin`; one that is given, at once."""
        if callable(period) or not period > 0:
            raise ConfigError(f"a timer's period is in s, as in @node.every(0.1), and found {period!r:.40}")

        def decorate(function: Callable[[], object]) -> Callable[[], object]:
            self._waits_for_spin = f"{getattr(function, '__name__', 'its timer')}() never ran"
            self.membership.loop.every(period, function)
            return function

        if function is not None:
            rclpy_names.expect_function(function)
            decorate(function)
        return decorate

    def spin(self, seconds: float | None = None) -> None:
        """Run handlers and timers until `stop`, a signal, or for some seconds."""
        self.membership.spin(seconds)

    def stop(self) -> None:
        """End the present `spin`, or the next one; safe from any thread."""
        self.membership.loop.stop()

    if not TYPE_CHECKING:  # which knows better what a Node has
        __getattr__ = rclpy_names.miss

    def _complain(self, text: str) -> None:
        self.log.warn(text, text.partition(":")[0])

    def _say(self, log: Log) -> None:
        if self._log_publisher:
            self._log_publisher.publish(log)
