"""What a node needs of whatever carries its messages: zenoh, or the door that speaks it for a robot."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol, Self

from zteleop.bus.lag import Lag
from zteleop.bus.loop import Loop
from zteleop.bus.settings import BEHIND, BusSettings


class Sample(NamedTuple):
    """What came under a key, in its bytes."""

    key: str
    payload: bytes
    encoding: str
    attachment: bytes | None = None
    is_put: bool = True
    """False: a delete; of a token, that it is gone"""
    at: float = 0.0
    """when it came to this machine, by the bus clock; 0 where nobody took note"""


class Question(NamedTuple):
    """What somebody asks under a key, and the two ways to answer it, once."""

    payload: bytes
    encoding: str
    answer: Callable[[bytes, str], object]
    """with bytes and their encoding"""
    refuse: Callable[[str], object]
    """with a sentence"""


class Reply(NamedTuple):
    """What was answered; the payload of a refusal is its sentence."""

    payload: bytes
    encoding: str
    refused: bool


class Undeclarable(Protocol):
    """What is done until it is undeclared."""

    def undeclare(self) -> None:
        """Take it back."""


class Ring(Protocol):
    """Keeps the newest samples of one key until they are read."""

    def recv(self) -> Sample:
        """Wait for a sample; raises EOFError when the session is closed."""

    def try_recv(self) -> Sample | None:
        """Return a sample that has arrived."""

    def undeclare(self) -> None:
        """Hear no more."""


class Overheard(Ring, Protocol):
    """A ring that says what it has lost."""

    @property
    def skipped(self) -> int:
        """How many samples were lost so far, as they came faster than they were read."""


class Outlet(Protocol):
    """Says bytes under one key."""

    @property
    def matched(self) -> bool:
        """Somebody hears it."""

    def put(self, payload: bytes, encoding: str, attachment: bytes | None) -> None:
        """Say bytes; raises BusError when the session is closed."""


class Inbox(Protocol):
    """A ring, and how to read what is in it."""

    ring: Ring
    lag: Lag
    """whether it is read as fast as it is filled"""

    def read(self, sample: Sample) -> Any | None:
        """Return what a sample says; None when it says nothing."""


class Delivery(Protocol):
    """Brings what arrives in an inbox to a handler, in the loop of its node."""

    def close(self) -> None:
        """Bring no more."""


class Session(Protocol):
    """One membership of the bus."""

    def subscribe(self, key: str, depth: int) -> Ring:
        """Return a ring of what is said under a key, of the `depth` newest."""

    def overhear(self, key: str, depth: int) -> Overheard:
        """Return a ring likewise, which counts what it loses: it costs more than one that does not."""

    def advertise(self, key: str, urgent: bool) -> Outlet:
        """Return what says bytes under a key; what is urgent overtakes the rest."""

    def unreached(self) -> Sequence[str]:
        """Return the endpoints it was to connect to, where nobody answers at any of them so far."""

    def declare_token(self, key: str) -> None:
        """Stand for something until this session ends."""

    def tokens(self, selector: str) -> set[str]:
        """Return the tokens there are."""

    def watch_tokens(self, selector: str, depth: int, history: bool = False) -> Ring:
        """Return a ring of the tokens that come and go; with `history`, also of those there are."""

    def serve(self, key: str, take: Callable[[Question], object]) -> None:
        """Hand over what is asked under a key, in any thread; raises BusError for a key that is none."""

    def ask(self, key: str, payload: bytes, encoding: str, seconds: float) -> Reply | None:
        """Return the first answer; None when nobody serves it, or nobody answers in time."""

    def deliver(self, inbox: Inbox, handler: Callable[[Any], object], loop: Loop) -> Delivery:
        """Hand what arrives to a handler in a loop, one message a round."""

    def attend(self, tell: Callable[[], object], loop: Loop, within: float) -> None:
        """Tell in a loop that something has arrived in some ring, at most `within` s after it did."""

    def close(self) -> None:
        """Leave the bus."""

    def __enter__(self) -> Self: ...

    def __exit__(self, *exc: object) -> None: ...


def open_session(
    settings: BusSettings, *, settle: bool = False, door: bool = False, patient: bool = False
) -> Session:
    """Join the bus; with `settle`, first wait (a second, longer on a busy machine) until everybody is found.

    With `door`, others join through this session. What is said waits for a place on a full link for a
    millisecond, then it is lost; with `patient`, for 5 s: for what is said once, and is no command.

    Raises ConfigError for an endpoint that is none, BusError when there is no router to a client.
    """
    if settings.connect and settings.connect[0].startswith(BEHIND):
        from zteleop.bus.door.remote import Remote  # and nothing of zenoh

        return Remote(settings.connect[0].removeprefix(BEHIND))
    from zteleop.bus.zenoh_open import open_zenoh  # not what reads settings needs it
    from zteleop.bus.zenoh_session import ZenohSession

    opened = open_zenoh(settings, settle=settle, door=door, patient=patient)
    return ZenohSession(opened, settings.connect)
