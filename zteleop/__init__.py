"""zteleop: teleoperation that installs in seconds, shows everything, and stops when it must."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from zteleop.bus.node import Node
    from zteleop.bus.publisher import Publisher
    from zteleop.bus.settings import BusSettings
    from zteleop.bus.subscription import Received, Subscription
    from zteleop.compat.pwm_controller import PWMController
    from zteleop.errors import BusError, ConfigError, DeviceError, MessageError, ZteleopError
    from zteleop.messages import (
        Beat,
        Bool,
        Channel,
        CompressedImage,
        DriveStatus,
        EmptyRequest,
        EmptyResponse,
        Header,
        Int16MultiArray,
        InterfaceButtons,
        Latency,
        Layer,
        Log,
        Message,
        MultiArrayDimension,
        MultiArrayLayout,
        Odometry,
        Point,
        Pose,
        PoseWithCovariance,
        Pulse,
        Pwm,
        Quaternion,
        Range,
        SetBoolRequest,
        SetBoolResponse,
        Stop,
        String,
        Time,
        TriggerRequest,
        TriggerResponse,
        Twist,
        TwistStamped,
        TwistWithCovariance,
        Vector3,
        Vehicle,
        WatchdogStatus,
        Why,
    )

_HOMES = {
    "BusError": "zteleop.errors",
    "BusSettings": "zteleop.bus.settings",
    "ConfigError": "zteleop.errors",
    "DeviceError": "zteleop.errors",
    "MessageError": "zteleop.errors",
    "Node": "zteleop.bus.node",
    "PWMController": "zteleop.compat.pwm_controller",
    "Publisher": "zteleop.bus.publisher",
    "Received": "zteleop.bus.subscription",
    "Subscription": "zteleop.bus.subscription",
    "ZteleopError": "zteleop.errors",
}

_OF_ROS = {
    "init": "the `with` of a Node",
    "shutdown": "the end of a Node's `with`",
    "spin": "node.spin()",
    "spin_once": "node.spin(seconds)",
    "ok": "node.spin(), which ends by itself",
    "create_node": "Node(name, robot=...)",
    "init_node": "Node(name, robot=...)",
}
"""what modules of ROS have -> what it is here"""

__all__ = [
    "Beat",
    "Bool",
    "BusError",
    "BusSettings",
    "Channel",
    "CompressedImage",
    "ConfigError",
    "DeviceError",
    "DriveStatus",
    "EmptyRequest",
    "EmptyResponse",
    "Header",
    "Int16MultiArray",
    "InterfaceButtons",
    "Latency",
    "Layer",
    "Log",
    "Message",
    "MessageError",
    "MultiArrayDimension",
    "MultiArrayLayout",
    "Node",
    "Odometry",
    "PWMController",
    "Point",
    "Pose",
    "PoseWithCovariance",
    "Publisher",
    "Pulse",
    "Pwm",
    "Quaternion",
    "Range",
    "Received",
    "SetBoolRequest",
    "SetBoolResponse",
    "Stop",
    "String",
    "Subscription",
    "Time",
    "TriggerRequest",
    "TriggerResponse",
    "Twist",
    "TwistStamped",
    "TwistWithCovariance",
    "Vector3",
    "Vehicle",
    "WatchdogStatus",
    "Why",
    "ZteleopError",
]


def __getattr__(name: str) -> Any:
    """Import what is asked for, when it is: `zteleop --help` needs neither bus nor messages."""
    if name not in __all__:
        here = f": here it is {_OF_ROS[name]} (docs/rclpy.md)" if name in _OF_ROS else ""
        raise AttributeError(f"zteleop has no {name!r}{here}")
    return getattr(import_module(_HOMES.get(name, "zteleop.messages")), name)
