"""Types that travel: a node tells what its own messages are made of to whoever has never imported them."""

from collections.abc import Callable, Iterable
from typing import TypeVar

import msgspec

from zteleop.bus import presence
from zteleop.bus.names import Name
from zteleop.bus.service import call
from zteleop.bus.session import Session
from zteleop.errors import BusError, MessageError
from zteleop.messages import MESSAGES, GetTypeRequest, GetTypeResponse, Message, is_called

M = TypeVar("M", bound=Message)
Types = type[M] | tuple[type[M], ...]

SERVICE = "get_type"
ANSWERED_WITHIN = 1.0


def kinds_of(types: Types[M]) -> tuple[type[M], ...]:
    """Return types of messages as a tuple; raises MessageError for what is none."""
    kinds = types if isinstance(types, tuple) else (types,)
    for kind in kinds:
        if not (isinstance(kind, type) and issubclass(kind, Message)):
            raise MessageError(f"expected a type of message, such as zteleop.Odometry, found {kind!r:.80}")
    return kinds


class OwnTypes:
    """Those that a node speaks and zteleop does not come with; what everybody has, nobody need tell."""

    def __init__(self, serve: Callable[[str, Callable[[GetTypeRequest], GetTypeResponse]], object]) -> None:
        self._serve = serve
        self._known: dict[str, type[Message]] = {}
        self._served: set[str] = set()

    def add(self, robot: str, kinds: Iterable[type[Message]]) -> None:
        """Tell of these from now on, to whoever asks for a robot's."""
        own = {kind.ros_type: kind for kind in kinds if kind.ros_type not in MESSAGES}
        self._known |= own
        if own and robot not in self._served:
            self._served.add(robot)
            self._serve(robot, self._tell)

    def _tell(self, asked: GetTypeRequest) -> GetTypeResponse:
        from zteleop.interfaces.schema import fingerprint, schema  # only where there is a type of one's own

        kind = self._known.get(asked.type)
        if kind is None:
            return GetTypeResponse(False, "", "")
        told = msgspec.json.encode(schema(kind, kind.ros_type))  # in which fields keep their order
        return GetTypeResponse(True, fingerprint(kind), told.decode())


def ask_type(session: Session, name: str) -> type[Message] | None:
    """Return the type of that name as somebody who speaks it tells it; None where nobody does.

    Raises MessageError for a type that is told, and is none.
    """
    from zteleop.interfaces.foreign import struct_of

    for one in presence.endpoints(session):
        if not one.hash or not is_called(one.type, name):
            continue
        service = Name(one.robot, f"{one.node}/{SERVICE}")
        try:
            told = call(session, service, GetTypeRequest(one.type), GetTypeResponse, ANSWERED_WITHIN)
        except BusError:  # it left, or does not spin: another may tell
            continue
        if told.found:
            return struct_of(_schema(told.schema), one.type)
    return None


def _schema(text: str) -> object:
    try:
        return msgspec.json.decode(text)
    except (msgspec.MsgspecError, RecursionError) as error:
        raise MessageError(f"expected a JSON Schema, found {text[:60]!r}: {error}") from None
