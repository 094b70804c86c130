"""Services: a node answers questions one after another in its loop; whoever asks waits for one answer."""

import threading
from collections import deque
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

from zteleop.bus import codec, presence
from zteleop.bus.loop import Loop
from zteleop.bus.names import Name
from zteleop.bus.session import Question, Session
from zteleop.errors import BusError, ConfigError, MessageError, nearest
from zteleop.messages import Message
from zteleop.messages.service import REQUEST, RESPONSE

R = TypeVar("R", bound=Message)
WAITING = 32
"""questions that wait for a node's loop; who asks then is told to ask again"""
BUSY = f"{WAITING} others wait for an answer; ask again later"
ANSWERED_WITHIN = 2.0
"""s to wait for an answer"""


class Service(NamedTuple):
    """How to answer what is asked under one name."""

    name: Name
    request: type[Message]
    response: type[Message]
    handler: Callable[[Any], Message]


class Services:
    """Those of one node; a handler that raises ends nothing: whoever asked is told, and `complain`."""

    def __init__(self, session: Session, node: str, loop: Loop, complain: Callable[[str], object]) -> None:
        self._session = session
        self._node = node
        self._loop = loop
        self._complain = complain
        self._waiting: deque[tuple[Service, Question]] = deque()
        self._taking = threading.Lock()

    def add(
        self,
        name: Name,
        request: type[Message],
        response: type[Message],
        handler: Callable[[Any], Message],
        *,
        stands: bool = True,
        at_once: bool = False,
    ) -> None:
        """Answer what is asked under a name; others are told of it, unless something else `stands` for it.

        With `at_once` in the thread that brings the question: for what asks nothing of the node, which may be
        busy, or spin never.
        Raises ConfigError for types that are not of one service.
        """
        ros_type = service_type_of(request, response)
        service = Service(name, request, response, handler)
        take = self._reply if at_once else self._take
        self._session.serve(service_key(name), lambda question: take(service, question))
        if stands:
            self._session.declare_token(presence.service_key(name, self._node, ros_type))

    def _take(self, service: Service, question: Question) -> None:
        """Let a question wait for its turn; called in threads of the session's."""
        with self._taking:
            if there_is_room := len(self._waiting) < WAITING:
                self._waiting.append((service, question))
        if there_is_room:
            self._loop.call_soon(self._answer_next)
        else:
            question.refuse(BUSY)

    def _answer_next(self) -> None:
        self._reply(*self._waiting.popleft())

    def _reply(self, service: Service, question: Question) -> None:
        try:
            payload = self._answer(service, question)
        except MessageError as error:
            question.refuse(str(error))
        except Exception as error:
            words = f"{type(error).__name__}: {error}"
            self._complain(f"/{service.name}: its handler failed: {words}")
            question.refuse(f"its handler failed: {words}")
        else:
            question.answer(payload, codec.encoding_of(service.response))

    def _answer(self, service: Service, question: Question) -> bytes:
        request = codec.decode(question.payload, question.encoding, codec.decoders([service.request]))
        response = service.handler(request)
        if not isinstance(response, service.response):
            raise TypeError(f"expected a {service.response.__name__} of its handler, found {response!r:.80}")
        return codec.encode(response)


def call(session: Session, name: Name, request: Message, response: type[R], seconds: float) -> R:
    """Ask, and return the answer.

    Raises BusError when nobody answers within some seconds, or whoever does refuses.
    """
    service_type_of(type(request), response)
    encoding = codec.encoding_of(type(request))
    reply = session.ask(service_key(name), codec.encode(request), encoding, seconds)
    if reply is None:
        raise BusError(_who_is_silent(session, name, seconds))
    if reply.refused:
        raise BusError(f"/{name} refuses: {reply.payload.decode(errors='replace')}")
    found: Any = codec.decode(reply.payload, reply.encoding, codec.decoders([response]))
    return found  # type: ignore[no-any-return]


def service_key(name: Name) -> str:
    """Return the key under which a service is asked."""
    return f"robot/{name.robot}/srv/{name.path}"


def service_type_of(request: type[Message], response: type[Message]) -> str:
    """Return what ROS calls the service of two messages; raises ConfigError when they are not of one."""
    ros_type = request.ros_type.removesuffix(REQUEST)
    if request.ros_type != ros_type + REQUEST or response.ros_type != ros_type + RESPONSE:
        raise ConfigError(
            f"expected the request and the response of one service, such as TriggerRequest and "
            f"TriggerResponse; found {request.__name__} and {response.__name__}"
        )
    return ros_type


def _who_is_silent(session: Session, name: Name, seconds: float) -> str:
    """Return who did not answer within some seconds, or what may have been meant where nobody serves it."""
    known, node = presence.services(session), name.path.rpartition("/")[0]
    those = [f"{one.node} on {one.process}" for one in known if (one.robot, one.topic) == name]
    if node and not those:  # what each node serves below its own name has no token of its own
        those = [f"{node} on {holder}" for holder in presence.holders(session, name.robot, node)]
    if those:
        return (
            f"{' and '.join(those)} did not answer /{name} within {seconds:g} s: it is busy, or does not spin"
        )
    lives = name.robot in presence.robots(session)  # then another robot's is not what was meant
    there = {f"/{one.robot}/{one.topic}" for one in known if not lives or one.robot == name.robot}
    return f"nobody serves /{name}" + (f"; {nearest(f'/{name}', there)}" if there else " here")
