"""What keeps a robot at rest, and who watches it."""

from typing import Annotated, ClassVar, Literal

from msgspec import Meta

from zteleop.messages.message import Message
from zteleop.messages.std import UInt32

Words = Annotated[str, Meta(max_length=200)]


class Stop(Message):
    """A stop, which stays beside all others until a release names it; anybody may say either."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Stop"

    engaged: bool
    """False releases the stop of this id, and no other."""
    id: Annotated[int, Meta(ge=0, lt=2**53)]
    """Random for each press, so that what a network delivers late releases nothing new."""
    by: Words
    """Who presses, as user@host; whoever presses again replaces their own."""
    why: Words


class Layer(Message):
    """What one part of the way from a key to a wheel says now."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Layer"

    name: str
    says: str


class Why(Message):
    """Why the robot moves as it does, or does not: a sentence for each layer; said five times a second."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Why"

    layers: list[Layer]


class WatchdogStatus(Message):
    """What the process above the actuator sees; said five times a second."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/WatchdogStatus"

    state: Literal["starting", "watching", "resting", "ended"]
    """resting: the actuator is gone and the watchdog keeps the chip at neutral; ended: its last word."""
    why: str
    silence: float
    """s since the actuator last reported a step."""
    moving: bool
    """The chip's pulses, as read back, are not those of rest."""
    allowed: bool
    """The watchdog itself has heard a command that may move the robot."""
    commands: UInt32
    """Heard since the watchdog began."""
    restarts: UInt32
    """Of the actuator."""
