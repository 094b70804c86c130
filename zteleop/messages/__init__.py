"""The vocabulary of the bus: one class a message, told apart by its ROS type."""

from zteleop.errors import MessageError
from zteleop.messages.drive import Beat, Channel, DriveStatus, Pulse, Pwm, State, Vehicle
from zteleop.messages.geometry import (
    Point,
    Pose,
    PoseWithCovariance,
    Quaternion,
    Twist,
    TwistStamped,
    TwistWithCovariance,
    Vector3,
)
from zteleop.messages.log import Log
from zteleop.messages.message import Message
from zteleop.messages.nav import Odometry
from zteleop.messages.safety import Layer, Stop, WatchdogStatus, Why
from zteleop.messages.std import (
    Bool,
    Header,
    Int16MultiArray,
    MultiArrayDimension,
    MultiArrayLayout,
    String,
    Time,
)

MESSAGES: dict[str, type[Message]] = {kind.ros_type: kind for kind in Message.__subclasses__()}
"""Every message by its ROS type."""


def message_type(name: str) -> type[Message]:
    """Return the class called `geometry_msgs/msg/Twist`, `geometry_msgs/Twist` or `Twist`.

    Raises MessageError with the nearest names when there is none.
    """
    *package, leaf = name.split("/")
    for ros_type, kind in MESSAGES.items():
        parts = ros_type.split("/")
        if leaf == parts[-1] and package in ([], parts[:1], parts[:2]):
            return kind
    from difflib import get_close_matches

    near = get_close_matches(leaf, [kind.__name__ for kind in MESSAGES.values()], 3, 0.5)
    known = f"did you mean {' or '.join(near)}?" if near else f"known: {', '.join(sorted(MESSAGES))}"
    raise MessageError(f"no message type {name!r}; {known}")


__all__ = [
    "MESSAGES",
    "Beat",
    "Bool",
    "Channel",
    "DriveStatus",
    "Header",
    "Int16MultiArray",
    "Layer",
    "Log",
    "Message",
    "MultiArrayDimension",
    "MultiArrayLayout",
    "Odometry",
    "Point",
    "Pose",
    "PoseWithCovariance",
    "Pulse",
    "Pwm",
    "Quaternion",
    "State",
    "Stop",
    "String",
    "Time",
    "Twist",
    "TwistStamped",
    "TwistWithCovariance",
    "Vector3",
    "Vehicle",
    "WatchdogStatus",
    "Why",
    "message_type",
]
