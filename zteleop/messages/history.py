"""What was said a while ago, as a black box keeps it."""

from typing import ClassVar

from zteleop.messages.message import Message


class Said(Message):
    """A message as it came, with the moment on the clock of whoever kept it, in s."""

    ros_type: ClassVar[str] = "zteleop_msgs/msg/Said"

    at: float
    path: str
    """its key below the robot"""
    encoding: str
    payload: bytes


class GetHistoryRequest(Message):
    """What was said on a topic within the last seconds, without what was had before."""

    ros_type: ClassVar[str] = "zteleop_msgs/srv/GetHistory_Request"

    topic: str
    seconds: float
    after: float
    """the moment of the last that was had; 0 for none"""
    had: int
    """how many of that very moment"""


class GetHistoryResponse(Message):
    """The oldest first, as much as one answer holds."""

    ros_type: ClassVar[str] = "zteleop_msgs/srv/GetHistory_Response"

    messages: list[Said]
    more: bool
    """there is more after the last of them"""
