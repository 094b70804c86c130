"""What a node is made of: a place on the bus, a loop, and ears for the robots that it commands."""

import os
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Any, TypeVar

from zteleop.bus import clock, codec, presence
from zteleop.bus.heard import Heard, Hears
from zteleop.bus.lag import Lag
from zteleop.bus.loop import Loop
from zteleop.bus.names import Name, resolve
from zteleop.bus.session import Delivery, Inbox, Outlet, Session
from zteleop.bus.subscription import Subscription
from zteleop.bus.topics import topic_of
from zteleop.errors import BusError, ConfigError
from zteleop.machine import signals
from zteleop.messages import Beat, Message, Refusals, Vehicle

T = TypeVar("T")
_GLANCE = 0.01
_INSIDES = os.path.dirname(__file__)


class Membership:
    """One node's, from its construction to `close`; `complain` hears of what is no message.

    Whoever commands proves which beat it had heard when it decided. So the robots are listened to before
    each handler and each `publish`, but not within a handler: what that decides, it decided on what was
    heard before it began.
    """

    def __init__(
        self, node: str, robot: str | None, session: Session, complain: Callable[[str], None]
    ) -> None:
        self.session = session
        self.loop = Loop(before_each=self.listen)
        self.link: Callable[[Outlet], Outlet] = _as_it_is
        """what an outlet is made into, for a link that is worse than it is"""
        self.echo: Callable[[Heard], Hears] = _as_heard
        """what commands echo of what is heard, where somebody else than this node acts"""
        self._node = node
        self._robot = robot
        self._complain = complain
        self._deliveries: list[Delivery] = []
        self._heard: dict[str, Heard] = {}
        self._handles = False
        self.has_spun = False
        self._closed = threading.Event()

    def close(self) -> None:
        """Leave the bus: others see this node go, and its threads end."""
        self._closed.set()
        self.session.close()  # first: it is what ends the waiting of the deliveries
        for delivery in self._deliveries:
            delivery.close()
        self.loop.close()

    def outlet(self, name: Name, types: tuple[type[Message], ...], urgent: bool) -> Outlet:
        """Return what says bytes on a topic, and tell everybody that it is there."""
        self.session.declare_token(presence.endpoint_key(name, "pub", self._node, types))
        return self.link(self.session.advertise(name.key, urgent))

    def inbox(
        self,
        topic: str,
        types: tuple[type[Message], ...],
        depth: int | None = None,
        complain: bool = True,
    ) -> Subscription[Any]:
        """Return what hears a topic, of a command topic all its sources; and tell everybody likewise."""
        name = resolve(topic, self._robot)
        about = topic_of(name.path)
        if about.command and name.path == about.name:
            name = Name(name.robot, f"{about.name}/**")
        ring = self.session.subscribe(name.key, depth or about.depth)
        self.session.declare_token(presence.endpoint_key(name, "sub", self._node, types))
        words = self._complain if complain else _keep_quiet
        lag = Lag(lambda said: words(f"{name.key}: {said}")) if (depth or about.depth) > 1 else None
        return Subscription(ring, codec.decoders(types), words, self.handling, lag)

    def deliver(self, inbox: Inbox, handler: Callable[[Any], object]) -> None:
        """Hand what arrives to a handler in the loop."""
        self._deliveries.append(self.session.deliver(inbox, handler, self.loop))

    def departures(self, handler: Callable[[int], object]) -> None:
        """Hand each sender of commands that is gone, by its number, to a handler in the loop."""
        self.deliver(presence.Departures(self.session, self.own_robot()), handler)

    def heard(self, robot: str | None = None) -> Heard:
        """Return what is heard of a robot, by default the node's own."""
        robot = robot or self.own_robot()
        if robot not in self._heard:
            self._heard[robot] = Heard(
                self.inbox(f"/{robot}/beat", (Beat,)),
                self.inbox(f"/{robot}/vehicle", (Vehicle,)),
                self.inbox(f"/{robot}/refusals", (Refusals,), complain=False),
            )
        return self._heard[robot]

    def own_robot(self) -> str:
        """Return the node's own robot; raises ConfigError where it has none."""
        if self._robot is None:
            raise ConfigError(f"node {self._node} has no robot; say Node({self._node!r}, robot=...)")
        return self._robot

    def spin(self, seconds: float | None = None) -> None:
        """Run the loop until it is stopped, or for some seconds; raises BusError once it is closed."""
        if self._closed.is_set():
            raise BusError(f"node {self._node} is closed; spin inside its `with`")
        self.has_spun = True
        with self.handling():
            try:
                self.loop.run(None if seconds is None else clock.now() + seconds)
            except Exception as error:  # whoever wrote the handler reads of that, and not of this loop
                error.__traceback__ = _of_program(error.__traceback__)
                raise

    def beside(self, look: Callable[[], float]) -> None:
        """Look in a thread, and again when it says, until the node closes: for who waits without a loop."""

        def run() -> None:
            try:
                while not self._closed.wait(look() - clock.now()):
                    pass
            except Exception:
                if not self._closed.is_set():  # else there is nothing left to look at
                    raise

        signals.start(threading.Thread(target=run, daemon=True))

    def until(self, look: Callable[[], T], seconds: float) -> T:
        """Spin until `look` finds something, at most for some seconds; return what it found last."""
        give_up = clock.now() + seconds
        while not (found := look()) and clock.now() < give_up:
            self.spin(_GLANCE)
        return found

    def listen(self) -> None:
        """Take in what the robots said."""
        for heard in self._heard.values():
            heard.awake_since = self.loop.awake_since
            heard.listen()

    def listen_now(self) -> None:
        """Listen on behalf of a publisher; in a handler what counts was heard before it began."""
        if not self._handles:
            self.listen()

    @contextmanager
    def handling(self) -> Iterator[None]:
        """Let what is commanded meanwhile prove no more than what was heard before."""
        outer = self._handles
        self._handles = True
        self.listen()
        try:
            yield
        finally:
            self._handles = outer


def _of_program(trace: TracebackType | None) -> TracebackType | None:
    """Return a traceback from the program's own line on: what is between `spin` and that says nothing."""
    while trace and trace.tb_next and trace.tb_frame.f_code.co_filename.startswith(_INSIDES):
        trace = trace.tb_next
    return trace


def _keep_quiet(text: str) -> None:
    """Leave it to somebody else to complain."""


def _as_it_is(outlet: Outlet) -> Outlet:
    return outlet


def _as_heard(heard: Heard) -> Hears:
    return heard
