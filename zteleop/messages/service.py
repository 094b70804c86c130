"""What is asked of a node and answered (std_srvs): two messages to a service, told apart by their ends."""

from typing import ClassVar

from zteleop.messages.message import Message
from zteleop.messages.std import Time

REQUEST, RESPONSE = "_Request", "_Response"


def is_half(ros_type: str) -> bool:
    """Say whether a message is one of the two of a service."""
    return ros_type.endswith((REQUEST, RESPONSE))


class GetTypeRequest(Message):
    """What a type is made of that a node speaks, and others may not know."""

    ros_type: ClassVar[str] = "zteleop_msgs/srv/GetType_Request"

    type: str


class GetTypeResponse(Message):
    ros_type: ClassVar[str] = "zteleop_msgs/srv/GetType_Response"

    found: bool
    hash: str
    """eight hexadecimal digits that two types share when their fields are the same"""
    schema: str
    """a JSON Schema, in which each message says its ROS type"""


class GetTimeRequest(Message):
    """What time of day it is where a node runs."""

    ros_type: ClassVar[str] = "zteleop_msgs/srv/GetTime_Request"


class GetTimeResponse(Message):
    ros_type: ClassVar[str] = "zteleop_msgs/srv/GetTime_Response"

    stamp: Time


class EmptyRequest(Message):
    ros_type: ClassVar[str] = "std_srvs/srv/Empty_Request"


class EmptyResponse(Message):
    ros_type: ClassVar[str] = "std_srvs/srv/Empty_Response"


class TriggerRequest(Message):
    ros_type: ClassVar[str] = "std_srvs/srv/Trigger_Request"


class TriggerResponse(Message):
    ros_type: ClassVar[str] = "std_srvs/srv/Trigger_Response"

    success: bool
    message: str


class SetBoolRequest(Message):
    ros_type: ClassVar[str] = "std_srvs/srv/SetBool_Request"

    data: bool


class SetBoolResponse(Message):
    ros_type: ClassVar[str] = "std_srvs/srv/SetBool_Response"

    success: bool
    message: str
