"""What a page and its server say to each other, in JSON; what is said on the bus passes as it is.

Pictures alone are bytes: the time of day in s as a big-endian double, then a JPEG.
"""

from typing import Annotated, Any, Literal

import msgspec
from msgspec import Meta, Raw, Struct

from zteleop.errors import MessageError

LONGEST = 65536
"""bytes of what a page says"""
Axis = Annotated[float, Meta(ge=-1, le=1)]
Words = Annotated[str, Meta(max_length=200)]
Topics = Annotated[list[Annotated[str, Meta(max_length=200)]], Meta(max_length=64)]


class Held(Struct, tag="held", tag_field="is", frozen=True, forbid_unknown_fields=True):
    """All that is held on a page, 50 times a second while anything is, and once when nothing is any more."""

    seq: Annotated[int, Meta(ge=0, lt=2**53)]
    drive: Axis
    """-1 to 1, forward"""
    turn: Axis
    """-1 to 1, to the left"""
    deadman: bool
    """Something is held: what it asks for counts."""
    epoch: Annotated[int, Meta(ge=0, lt=2**53)]
    """of the newest beat of the robot that this page has heard, as its time is: nobody else echoes them"""
    beat: float


class Wish(Struct, tag="wish", tag_field="is", frozen=True, forbid_unknown_fields=True):
    """What somebody wants once. Anybody may stop, and release a stop; the rest is about the wheel."""

    of: Literal["stop", "release", "take", "hand over"]
    why: Words = ""


class Watch(Struct, tag="watch", tag_field="is", frozen=True, forbid_unknown_fields=True):
    """All the topics that a page wants to hear from now on, by their names on the bus."""

    topics: Topics


class Look(Struct, tag="look", tag_field="is", frozen=True, forbid_unknown_fields=True):
    """What a page shows and wants to be told of: nodes and topics, the nodes' parameters, all robots."""

    graph: bool
    parameters: bool
    robots: bool


class Setting(Struct, tag="set", tag_field="is", frozen=True, forbid_unknown_fields=True):
    """Another value for a parameter; the node that has it says whether it may be."""

    node: Words
    name: Words
    value: bool | int | float | Words


class Press(Struct, tag="press", tag_field="is", frozen=True, forbid_unknown_fields=True):
    """A key of whoever answers the questions of `zteleop calibrate`, or a button that stands for one."""

    key: Words
    beat: float
    """of the newest question that this page has been told, as its time is"""


Said = Held | Wish | Watch | Look | Setting | Press


class Hello(Struct, tag="hello", tag_field="is", frozen=True):
    """The first word of a server: which robot this is, and what the page is called."""

    robot: str
    version: str
    you: str


class Heard(Struct, tag="heard", tag_field="is", frozen=True):
    """What was said on the bus, as it was said."""

    topic: str
    type: str
    message: Raw


class Wheel(Struct, tag="wheel", tag_field="is", frozen=True):
    """Who drives from a page of this server, and who watches."""

    holder: str
    """nobody's while it is empty"""
    pages: list[str]


class Seen(Struct, tag="seen", tag_field="is", frozen=True):
    """What the operator of this server knows that is not on the bus."""

    obeyed: bool
    """The robot does what is held on the page that has the wheel."""
    refused: str
    """why not, in the robot's words"""
    note: str
    """what the robot answers to a stop, or complains of"""
    alarm: bool
    """the note must be read now"""
    silence: float
    """s for which the robot has said nothing, where that is too long"""


class Note(Struct, tag="note", tag_field="is", frozen=True):
    """A sentence for whoever sits before the page."""

    says: str
    alarm: bool = False


class Topic(Struct, frozen=True):
    """A topic, by the name that a page watches it by."""

    name: str
    types: list[str]
    said_by: list[str]
    """nodes, by a name for each process"""
    heard_by: list[str]
    hz: float


class Graph(Struct, tag="graph", tag_field="is", frozen=True):
    """Who says what to whom, and how often it was said lately."""

    topics: list[Topic]


class Tuned(Struct, frozen=True):
    """A parameter, and what it may be."""

    node: str
    name: str
    type: str
    """as `ros2 param` calls it"""
    value: Any
    says: str
    least: float | None
    most: float | None
    choices: list[str]
    read_only: bool


class Parameters(Struct, tag="parameters", tag_field="is", frozen=True):
    """Those of all nodes of the robot."""

    parameters: list[Tuned]


class Robot(Struct, frozen=True):
    """A robot on the bus; `operator` is called as everywhere, and nobody's while it is empty."""

    name: str
    state: str
    why: str
    operator: str


class Robots(Struct, tag="robots", tag_field="is", frozen=True):
    """All that were heard within the last minute."""

    robots: list[Robot]


class Asks(Struct, tag="asks", tag_field="is", frozen=True):
    """A question of `zteleop calibrate`, and how the robot stands."""

    step: int
    """which, from 1, of so many `steps`"""
    steps: int
    axis: str
    """which servo is turned"""
    asks: str
    """until when"""
    brakes: bool
    """many an ESC brakes first"""
    found: list[str]
    state: str
    why: str
    note: str
    """why what was just pressed counts for nothing"""
    out: dict[str, int]
    """ticks that leave the chip, by servo"""
    idle_left: float | None
    """s until neutral for want of a press; None when it is neutral already"""
    beat: float
    """the robot's time"""


class Told(Struct, tag="told", tag_field="is", frozen=True):
    """Where no question is asked: what there is to do before, meanwhile, or after all of them."""

    lines: list[str]
    begins: str = ""
    """what to press for it to begin; empty where that is not asked for"""
    ends: bool = False
    """nothing comes after this"""


_decoder = msgspec.json.Decoder(Said)
_encoder = msgspec.json.Encoder()


def read(frame: str | bytes) -> Said:
    """Return what a page says; raises MessageError for anything else."""
    if isinstance(frame, bytes):
        raise MessageError("expected text, found bytes; load the page anew")
    try:
        return _decoder.decode(frame)
    except (msgspec.DecodeError, UnicodeEncodeError) as error:
        raise MessageError(f"expected what a page of this server says, found another: {error}") from None


def text(word: Hello | Heard | Wheel | Seen | Note | Graph | Parameters | Robots | Asks | Told) -> str:
    """Return what a server says, as it is sent."""
    return _encoder.encode(word).decode()
