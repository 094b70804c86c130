"""What a robot feels and sees (sensor_msgs)."""

from typing import Annotated, ClassVar

from msgspec import Meta

from zteleop.messages.geometry import Quaternion, Vector3
from zteleop.messages.message import Message
from zteleop.messages.std import Header, UInt8

Covariance3 = Annotated[list[float], Meta(min_length=9, max_length=9)]
"""Of three values; the first is -1 where nobody knows them."""


class BatteryState(Message):
    """Volts, amperes (negative while it discharges), ampere hours, and a percentage from 0 to 1."""

    ros_type: ClassVar[str] = "sensor_msgs/msg/BatteryState"

    header: Header
    voltage: float
    temperature: float
    current: float
    charge: float
    capacity: float
    design_capacity: float
    percentage: float
    power_supply_status: UInt8
    """1 charging, 2 discharging, 3 not charging, 4 full."""
    power_supply_health: UInt8
    power_supply_technology: UInt8
    present: bool
    cell_voltage: list[float]
    cell_temperature: list[float]
    location: str
    serial_number: str


class Imu(Message):
    ros_type: ClassVar[str] = "sensor_msgs/msg/Imu"

    header: Header
    orientation: Quaternion
    orientation_covariance: Covariance3
    angular_velocity: Vector3
    """rad/s"""
    angular_velocity_covariance: Covariance3
    linear_acceleration: Vector3
    """m/s^2"""
    linear_acceleration_covariance: Covariance3


class Range(Message):
    """A distance in m; `max_range` where there is nothing so near."""

    ros_type: ClassVar[str] = "sensor_msgs/msg/Range"

    header: Header
    radiation_type: UInt8
    """0 ultrasound, 1 infrared."""
    field_of_view: float
    """rad"""
    min_range: float
    max_range: float
    range: float
    variance: float


class CompressedImage(Message):
    ros_type: ClassVar[str] = "sensor_msgs/msg/CompressedImage"

    header: Header
    format: str
    """jpeg or png"""
    data: bytes
