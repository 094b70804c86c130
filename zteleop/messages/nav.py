"""Where the robot is (nav_msgs)."""

from typing import ClassVar

from zteleop.messages.geometry import PoseWithCovariance, TwistWithCovariance
from zteleop.messages.message import Message
from zteleop.messages.std import Header


class Odometry(Message):
    """Pose in `header.frame_id`, twist in `child_frame_id`."""

    ros_type: ClassVar[str] = "nav_msgs/msg/Odometry"

    header: Header
    child_frame_id: str
    pose: PoseWithCovariance
    twist: TwistWithCovariance
