"""What the robot's own processes ask of the door, and what it answers: MessagePack, a frame a structure."""

from msgspec import Struct

LARGEST = 2**21
"""bytes of a frame"""


class Subscribe(Struct, array_like=True, frozen=True, tag=1):
    """Hear what is said under a key, of the `depth` newest."""

    id: int
    key: str
    depth: int


class WatchTokens(Struct, array_like=True, frozen=True, tag=2):
    """Hear of the tokens that come and go."""

    id: int
    selector: str
    depth: int
    history: bool


class Advertise(Struct, array_like=True, frozen=True, tag=3):
    """Be about to say something under a key."""

    id: int
    key: str
    urgent: bool


class Stand(Struct, array_like=True, frozen=True, tag=4):
    """Declare a token."""

    id: int
    key: str


class Undeclare(Struct, array_like=True, frozen=True, tag=5):
    """Take back any of these."""

    id: int


class Put(Struct, array_like=True, frozen=True, tag=6):
    """Say bytes under the key of an Advertise."""

    id: int
    payload: bytes
    encoding: str
    attachment: bytes | None


class AskTokens(Struct, array_like=True, frozen=True, tag=7):
    """Ask which tokens there are."""

    id: int
    selector: str


class Serve(Struct, array_like=True, frozen=True, tag=8):
    """Be asked under a key."""

    id: int
    key: str


class Replied(Struct, array_like=True, frozen=True, tag=9):
    """The answer to an Asked; the payload of a refusal is its sentence."""

    question: int
    payload: bytes
    encoding: str
    refused: bool


Declaration = Subscribe | WatchTokens | Advertise | Stand | Serve
Ask = Declaration | Undeclare | Put | AskTokens | Replied


class Hello(Struct, array_like=True, frozen=True, tag=1):
    """The first word of a door: it is open."""


class Arrived(Struct, array_like=True, frozen=True, tag=2):
    """A sample, for the Subscribe or WatchTokens of that id."""

    id: int
    key: str
    payload: bytes
    encoding: str
    attachment: bytes | None
    is_put: bool
    at: float


class Tokens(Struct, array_like=True, frozen=True, tag=3):
    """The answer to an AskTokens."""

    id: int
    keys: list[str]


class Asked(Struct, array_like=True, frozen=True, tag=4):
    """What somebody asks, for the Serve of that id."""

    id: int
    question: int
    payload: bytes
    encoding: str


Answer = Hello | Arrived | Tokens | Asked
