"""The vocabulary of the bus: one class a message, told apart by its ROS type."""

from collections.abc import Iterable

from zteleop.errors import MessageError, nearest
from zteleop.messages.drive import (
    Beat,
    Channel,
    Confirmed,
    DriveStatus,
    Hop,
    Latency,
    Pulse,
    Pwm,
    Refusals,
    Refused,
    State,
    Vehicle,
)
from zteleop.messages.geometry import (
    Point,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    Quaternion,
    Transform,
    TransformStamped,
    Twist,
    TwistStamped,
    TwistWithCovariance,
    Vector3,
)
from zteleop.messages.history import GetHistoryRequest, GetHistoryResponse, Said
from zteleop.messages.irobot import (
    AudioNote,
    AudioNoteVector,
    Button,
    DockStatus,
    HazardDetection,
    HazardDetectionVector,
    InterfaceButtons,
    LedColor,
    LightringLeds,
    StopStatus,
    WheelTicks,
    WheelVels,
)
from zteleop.messages.log import Log
from zteleop.messages.message import Message
from zteleop.messages.nav import Odometry
from zteleop.messages.parameters import (
    DescribeParametersRequest,
    DescribeParametersResponse,
    FloatingPointRange,
    GetParametersRequest,
    GetParametersResponse,
    IntegerRange,
    ListParametersRequest,
    ListParametersResponse,
    ListParametersResult,
    Parameter,
    ParameterDescriptor,
    ParameterEvent,
    ParameterValue,
    SetParametersRequest,
    SetParametersResponse,
    SetParametersResult,
)
from zteleop.messages.safety import Layer, Stop, WatchdogStatus, Why
from zteleop.messages.sensor import BatteryState, CompressedImage, Imu, Range
from zteleop.messages.service import (
    REQUEST,
    RESPONSE,
    EmptyRequest,
    EmptyResponse,
    GetTimeRequest,
    GetTimeResponse,
    GetTypeRequest,
    GetTypeResponse,
    SetBoolRequest,
    SetBoolResponse,
    TriggerRequest,
    TriggerResponse,
    is_half,
)
from zteleop.messages.std import (
    Bool,
    Duration,
    Header,
    Int16MultiArray,
    MultiArrayDimension,
    MultiArrayLayout,
    String,
    Time,
)
from zteleop.messages.tf import TFMessage

MESSAGES: dict[str, type[Message]] = {kind.ros_type: kind for kind in Message.__subclasses__()}
"""Every message by its ROS type."""

SERVICES: dict[str, tuple[type[Message], type[Message]]] = {
    ros_type.removesuffix(REQUEST): (kind, MESSAGES[ros_type.removesuffix(REQUEST) + RESPONSE])
    for ros_type, kind in MESSAGES.items()
    if ros_type.endswith(REQUEST)
}
"""Request and response of every service by its ROS type."""


def message_type(name: str) -> type[Message]:
    """Return the class called `geometry_msgs/msg/Twist`, `geometry_msgs/Twist` or `Twist`.

    Raises MessageError with the nearest names when there is none.
    """
    return MESSAGES[_full_name(name, MESSAGES, "message type")]


def service_type(name: str) -> tuple[type[Message], type[Message]]:
    """Return request and response of the service called `std_srvs/srv/SetBool` or `SetBool`."""
    return SERVICES[_full_name(name, SERVICES, "service type")]


def is_called(ros_type: str, name: str) -> bool:
    """Say whether a type may be called so: by its full name, without `msg`, or by its end alone."""
    *package, leaf = name.split("/")
    parts = ros_type.split("/")
    return leaf == parts[-1] and package in ([], parts[:1], parts[:2])


def _full_name(name: str, known: Iterable[str], what: str) -> str:
    found = next((ros_type for ros_type in known if is_called(ros_type, name)), None)
    if found is None:
        shown = [ros_type for ros_type in known if not is_half(ros_type)]
        raise MessageError(f"no {what} {name!r}; {nearest(name, shown)}")
    return found


__all__ = [
    "MESSAGES",
    "SERVICES",
    "AudioNote",
    "AudioNoteVector",
    "BatteryState",
    "Beat",
    "Bool",
    "Button",
    "Channel",
    "CompressedImage",
    "Confirmed",
    "DescribeParametersRequest",
    "DescribeParametersResponse",
    "DockStatus",
    "DriveStatus",
    "Duration",
    "EmptyRequest",
    "EmptyResponse",
    "FloatingPointRange",
    "GetHistoryRequest",
    "GetHistoryResponse",
    "GetParametersRequest",
    "GetParametersResponse",
    "GetTimeRequest",
    "GetTimeResponse",
    "GetTypeRequest",
    "GetTypeResponse",
    "HazardDetection",
    "HazardDetectionVector",
    "Header",
    "Hop",
    "Imu",
    "Int16MultiArray",
    "IntegerRange",
    "InterfaceButtons",
    "Latency",
    "Layer",
    "LedColor",
    "LightringLeds",
    "ListParametersRequest",
    "ListParametersResponse",
    "ListParametersResult",
    "Log",
    "Message",
    "MultiArrayDimension",
    "MultiArrayLayout",
    "Odometry",
    "Parameter",
    "ParameterDescriptor",
    "ParameterEvent",
    "ParameterValue",
    "Point",
    "Pose",
    "PoseStamped",
    "PoseWithCovariance",
    "Pulse",
    "Pwm",
    "Quaternion",
    "Range",
    "Refusals",
    "Refused",
    "Said",
    "SetBoolRequest",
    "SetBoolResponse",
    "SetParametersRequest",
    "SetParametersResponse",
    "SetParametersResult",
    "State",
    "Stop",
    "StopStatus",
    "String",
    "TFMessage",
    "Time",
    "Transform",
    "TransformStamped",
    "TriggerRequest",
    "TriggerResponse",
    "Twist",
    "TwistStamped",
    "TwistWithCovariance",
    "Vector3",
    "Vehicle",
    "WatchdogStatus",
    "WheelTicks",
    "WheelVels",
    "Why",
    "message_type",
    "service_type",
]
