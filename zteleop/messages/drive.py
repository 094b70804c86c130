"""What an actuator obeys and what it says of itself."""

from typing import Annotated, ClassVar, Literal

from msgspec import Meta

from zteleop.messages.geometry import Twist
from zteleop.messages.message import Message
from zteleop.messages.safety import Stop
from zteleop.messages.std import Int16

State = Literal["starting", "idle", "driving", "link lost", "operator idle", "stopped", "fault"]
Confirmed = Literal["", "read", "cut"]


class Pwm(Message):
    """Pulse lengths as counts of the chip's 4096 a period; fields that follow are ignored by old readers."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Pwm"

    steering_ticks: Int16
    throttle_ticks: Int16


class Beat(Message):
    """The robot's own clock, for commands to echo; a new epoch is a new start."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Beat"

    epoch: Annotated[int, Meta(ge=0, lt=2**53)]
    time: float
    floor: float
    """Claims that began up to then are over: the start, or the latest release of a stop or a fault."""


class Channel(Message):
    """One output of the vehicle and its calibration; min is full right or full reverse."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Channel"

    name: str
    channel: int
    min_us: float
    neutral_us: float
    max_us: float
    min_ticks: int
    neutral_ticks: int
    max_ticks: int
    dead_ticks: int
    """To either side of neutral, where a motor does not turn yet."""

    def is_dead(self, ticks: int) -> bool:
        """Say whether these ticks ask a motor to turn, and by too little."""
        return 0 < abs(ticks - self.neutral_ticks) <= self.dead_ticks


class Vehicle(Message):
    """What an input must know of the robot it drives; said five times a second."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Vehicle"

    kind: str
    """What its mixer is called."""
    channels: list[Channel]
    max_speed: float
    max_turn: float
    """rad/s; for a car, at full speed and full lock."""
    wheelbase: float
    """m between the axles; 0 where there is only one."""
    max_steering_angle: float
    """rad; 0 where nothing steers."""
    operator_silence: float
    """s without an act until neutral."""
    tick_us: float
    """us of one count of the chip."""
    ready: bool
    """Its start is over: whoever begins now may drive it, unless it is stopped."""
    allowed_speed: float
    """m/s that its parameters let it drive now, of max_speed."""

    @property
    def steers(self) -> bool:
        """Whether it turns by wheels that steer, and so not on the spot."""
        return self.max_steering_angle > 0

    @property
    def takes_ticks(self) -> bool:
        """Whether the pulses of a steering and a throttle drive it."""
        return {"steering", "throttle"} <= {channel.name for channel in self.channels}


class Pulse(Message):
    """What one channel of the chip took last."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Pulse"

    name: str
    channel: int
    fraction: float
    """-1 to 1 of the channel's range."""
    pulse_us: float
    duty_ticks: int


class DriveStatus(Message):
    """What the actuator does, on whose word, and why."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/DriveStatus"

    state: State
    why: str
    source: str
    operator: str
    """Sender of the command obeyed, in hexadecimal; empty when nobody drives."""
    wanted: Twist
    applied: Twist
    pulses: list[Pulse]
    seq: int
    """Of the last command accepted."""
    written: float
    """When the chip took these pulses, by the robot's clock; what it does not take is never shown."""
    stops: list[Stop]
    """In force, the oldest first; each stays until a release names its id."""
    confirmed: Confirmed
    """How a robot with a stop in force is known to stand: neutral was read back, or its outputs are cut."""
    unkept: str
    """Why they would not outlive a restart; empty when they would."""
    refused: int
    clamped: int
    max_speed: float
    """m/s that bound it now."""
    latency: float
    """s; the 99th percentile of how old the driver's commands are on arrival; 0 when nobody drives."""
    slowed: str
    """Why max_speed is less than the vehicle's own; empty when it is not."""
    released: Annotated[int, Meta(ge=0, lt=2**53)]
    """The id of the last stop that was released, also before the robot's start; 0 when there was none."""


class Refused(Message):
    """A sender whose commands do not count."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Refused"

    sender: str
    """In hexadecimal."""
    source: str
    why: Annotated[str, Meta(max_length=200)]
    by: str
    """Who drives this source in its place, such as `keyboard 18d4`; empty where nobody does."""
    since: float
    """s."""


class Refusals(Message):
    """Who has been refused for more than 0.5 s; said five times a second, and only while somebody is."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Refusals"

    refused: list[Refused]
    rest: str
    """What keeps the robot at rest, whoever commands; empty when nothing does."""
    released: Annotated[int, Meta(ge=0, lt=2**53)]
    """As in DriveStatus."""


class Hop(Message):
    """A part of the way from a key to a wheel, and how long commands took on it."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Hop"

    name: str
    commands: int
    median: float
    """s"""
    worst: float
    """s"""


class Latency(Message):
    """How long commands took where one process has them; said once a second, and only while there are any."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Latency"

    by: str
    """Who says so: `actuator`, or an operator's input as it is called everywhere, such as `keyboard 18d4`."""
    hops: list[Hop]
    """In the order in which they are passed."""
