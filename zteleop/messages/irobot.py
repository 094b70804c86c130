"""The buttons, lights, notes, wheels and dangers of an iRobot Create 3 (irobot_create_msgs)."""

from typing import Annotated, ClassVar

from msgspec import Meta

from zteleop.messages.message import Message
from zteleop.messages.std import Duration, Header, Int32, Time, UInt8, UInt16


class Button(Message):
    """One button, and since when or how long it is or was down."""

    ros_type: ClassVar[str] = "irobot_create_msgs/msg/Button"

    header: Header
    is_pressed: bool
    last_start_pressed_time: Time
    last_pressed_duration: Duration


class InterfaceButtons(Message):
    """button_1 is the left one, with one dot; button_2 the right one, with two."""

    ros_type: ClassVar[str] = "irobot_create_msgs/msg/InterfaceButtons"

    header: Header
    button_1: Button
    button_power: Button
    button_2: Button

    @property
    def pressed(self) -> bool:
        """Say whether any of them is down."""
        return self.button_1.is_pressed or self.button_power.is_pressed or self.button_2.is_pressed


class LedColor(Message):
    ros_type: ClassVar[str] = "irobot_create_msgs/msg/LedColor"

    red: UInt8
    green: UInt8
    blue: UInt8


class LightringLeds(Message):
    """Six lights around the power button, the first at 4 o'clock, then counter-clockwise."""

    ros_type: ClassVar[str] = "irobot_create_msgs/msg/LightringLeds"

    header: Header
    leds: Annotated[list[LedColor], Meta(min_length=6, max_length=6)]
    override_system: bool
    """False gives the lights back to the robot."""


class AudioNote(Message):
    ros_type: ClassVar[str] = "irobot_create_msgs/msg/AudioNote"

    frequency: UInt16
    """Hz"""
    max_runtime: Duration


class AudioNoteVector(Message):
    ros_type: ClassVar[str] = "irobot_create_msgs/msg/AudioNoteVector"

    header: Header
    notes: list[AudioNote]
    append: bool
    """False ends what plays now."""


class DockStatus(Message):
    ros_type: ClassVar[str] = "irobot_create_msgs/msg/DockStatus"

    header: Header
    dock_visible: bool
    is_docked: bool


class HazardDetection(Message):
    """A danger, and where it is: `header.frame_id`, such as bump_front_left."""

    ros_type: ClassVar[str] = "irobot_create_msgs/msg/HazardDetection"

    header: Header
    type: UInt8
    """0 backup limit, 1 bump, 2 cliff, 3 stall, 4 wheel drop, 5 object near."""


class HazardDetectionVector(Message):
    ros_type: ClassVar[str] = "irobot_create_msgs/msg/HazardDetectionVector"

    header: Header
    detections: list[HazardDetection]


class WheelTicks(Message):
    """What the wheels have turned since the start, in ticks of their encoders."""

    ros_type: ClassVar[str] = "irobot_create_msgs/msg/WheelTicks"

    header: Header
    ticks_left: Int32
    ticks_right: Int32


class WheelVels(Message):
    """rad/s of each wheel."""

    ros_type: ClassVar[str] = "irobot_create_msgs/msg/WheelVels"

    header: Header
    velocity_left: float
    velocity_right: float


class StopStatus(Message):
    ros_type: ClassVar[str] = "irobot_create_msgs/msg/StopStatus"

    header: Header
    is_stopped: bool
