"""Where each frame is in another (tf2_msgs)."""

from typing import ClassVar

from zteleop.messages.geometry import TransformStamped
from zteleop.messages.message import Message


class TFMessage(Message):
    ros_type: ClassVar[str] = "tf2_msgs/msg/TFMessage"

    transforms: list[TransformStamped]
