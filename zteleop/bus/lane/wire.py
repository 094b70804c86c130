"""The two datagrams, and what is none."""

from typing import Annotated

import msgspec
from msgspec import Meta, Struct

from zteleop.messages import Confirmed, Stop

LONGEST = 1200
"""bytes of a datagram, which no network divides"""
_Text = Annotated[str, Meta(max_length=200)]
_Robot = Annotated[str, Meta(max_length=64)]
_Id = Annotated[int, Meta(ge=1, lt=2**53)]


class Asked(Struct, frozen=True, tag_field="zteleop", tag="stop"):
    """A stop, for one robot by its name."""

    robot: _Robot
    id: _Id
    by: _Text
    why: _Text = ""
    answer_to: tuple[_Robot, Annotated[int, Meta(gt=0, lt=2**16)]] | None = None
    """Address and port of whoever asks, where another robot of the same machine passed it on."""

    @property
    def stop(self) -> Stop:
        return Stop(engaged=True, id=self.id, by=self.by, why=self.why)


class Answered(Struct, frozen=True, tag_field="zteleop", tag="answer"):
    """How the robot stands."""

    robot: _Robot
    id: _Id
    held: bool
    """The stop is in force."""
    confirmed: Confirmed = ""
    """How the robot is known to stand; empty while it is not."""
    unkept: _Text = ""
    """Why the stop would not outlive a restart; empty when it would."""
    trouble: _Text = ""
    """Why the chip cannot be read; empty when it can."""


_asked, _answered = msgspec.json.Decoder(Asked), msgspec.json.Decoder(Answered)
_NONE = (msgspec.MsgspecError, UnicodeDecodeError, RecursionError)


def pack(said: Asked | Answered) -> bytes:
    return msgspec.json.encode(said)


def unpack_asked(data: bytes) -> Asked | None:
    """Return the stop in a datagram; None when it is none."""
    try:
        return _asked.decode(data)
    except _NONE:
        return None


def unpack_answered(data: bytes) -> Answered | None:
    """Return the answer in a datagram; None when it is none."""
    try:
        return _answered.decode(data)
    except _NONE:
        return None
