"""What nodes say in words (rcl_interfaces)."""

from typing import ClassVar

from zteleop.messages.message import Message
from zteleop.messages.std import Time, UInt8, UInt32


class Log(Message):
    ros_type: ClassVar[str] = "rcl_interfaces/msg/Log"

    DEBUG: ClassVar[int] = 10
    INFO: ClassVar[int] = 20
    WARN: ClassVar[int] = 30
    ERROR: ClassVar[int] = 40
    FATAL: ClassVar[int] = 50

    stamp: Time
    level: UInt8
    name: str
    msg: str
    file: str
    function: str
    line: UInt32
