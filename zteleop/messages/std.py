"""Stamps, headers and plain values (builtin_interfaces, std_msgs)."""

from typing import Annotated, ClassVar

from msgspec import Meta

from zteleop.messages.message import Message

Int8 = Annotated[int, Meta(ge=-(2**7), lt=2**7)]
Int16 = Annotated[int, Meta(ge=-(2**15), lt=2**15)]
Int32 = Annotated[int, Meta(ge=-(2**31), lt=2**31)]
Int64 = Annotated[int, Meta(ge=-(2**63), le=2**63 - 1)]
UInt8 = Annotated[int, Meta(ge=0, lt=2**8)]
UInt16 = Annotated[int, Meta(ge=0, lt=2**16)]
UInt32 = Annotated[int, Meta(ge=0, lt=2**32)]
UInt64 = Annotated[int, Meta(ge=0)]  # msgspec bounds nothing above 63 bits


class Time(Message):
    """Seconds and nanoseconds since 1970."""

    ros_type: ClassVar[str] = "builtin_interfaces/msg/Time"

    sec: Int32
    nanosec: UInt32


class Duration(Message):
    """Seconds, and nanoseconds that are added to them."""

    ros_type: ClassVar[str] = "builtin_interfaces/msg/Duration"

    sec: Int32
    nanosec: UInt32


class Header(Message):
    ros_type: ClassVar[str] = "std_msgs/msg/Header"

    stamp: Time
    frame_id: str


class Bool(Message):
    ros_type: ClassVar[str] = "std_msgs/msg/Bool"

    data: bool


class String(Message):
    ros_type: ClassVar[str] = "std_msgs/msg/String"

    data: str


class MultiArrayDimension(Message):
    ros_type: ClassVar[str] = "std_msgs/msg/MultiArrayDimension"

    label: str
    size: UInt32
    stride: UInt32


class MultiArrayLayout(Message):
    ros_type: ClassVar[str] = "std_msgs/msg/MultiArrayLayout"

    dim: list[MultiArrayDimension]
    data_offset: UInt32


class Int16MultiArray(Message):
    """The Donkeycar nodes' `controls`: data is [steering, throttle, ...] in ticks."""

    ros_type: ClassVar[str] = "std_msgs/msg/Int16MultiArray"

    layout: MultiArrayLayout
    data: list[Int16]
