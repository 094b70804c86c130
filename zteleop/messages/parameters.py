"""What can be changed in a node while it runs, as ROS says it (rcl_interfaces)."""

from typing import Annotated, ClassVar

from msgspec import Meta

from zteleop.messages.message import Message
from zteleop.messages.std import Int64, Time, UInt8, UInt64


class ParameterValue(Message):
    """One value; `type` says which of the fields counts."""

    ros_type: ClassVar[str] = "rcl_interfaces/msg/ParameterValue"

    NOT_SET: ClassVar[int] = 0
    BOOL: ClassVar[int] = 1
    INTEGER: ClassVar[int] = 2
    DOUBLE: ClassVar[int] = 3
    STRING: ClassVar[int] = 4
    BYTE_ARRAY: ClassVar[int] = 5
    BOOL_ARRAY: ClassVar[int] = 6
    INTEGER_ARRAY: ClassVar[int] = 7
    DOUBLE_ARRAY: ClassVar[int] = 8
    STRING_ARRAY: ClassVar[int] = 9

    type: UInt8
    bool_value: bool
    integer_value: Int64
    double_value: float
    string_value: str
    byte_array_value: list[UInt8]
    bool_array_value: list[bool]
    integer_array_value: list[Int64]
    double_array_value: list[float]
    string_array_value: list[str]


class Parameter(Message):
    ros_type: ClassVar[str] = "rcl_interfaces/msg/Parameter"

    name: str
    value: ParameterValue


class FloatingPointRange(Message):
    """A step of 0 is none."""

    ros_type: ClassVar[str] = "rcl_interfaces/msg/FloatingPointRange"

    from_value: float
    to_value: float
    step: float


class IntegerRange(Message):
    ros_type: ClassVar[str] = "rcl_interfaces/msg/IntegerRange"

    from_value: Int64
    to_value: Int64
    step: UInt64


class ParameterDescriptor(Message):
    ros_type: ClassVar[str] = "rcl_interfaces/msg/ParameterDescriptor"

    name: str
    type: UInt8
    description: str
    additional_constraints: str
    read_only: bool
    dynamic_typing: bool
    floating_point_range: Annotated[list[FloatingPointRange], Meta(max_length=1)]
    integer_range: Annotated[list[IntegerRange], Meta(max_length=1)]


class SetParametersResult(Message):
    ros_type: ClassVar[str] = "rcl_interfaces/msg/SetParametersResult"

    successful: bool
    reason: str


class ListParametersResult(Message):
    ros_type: ClassVar[str] = "rcl_interfaces/msg/ListParametersResult"

    names: list[str]
    prefixes: list[str]


class ParameterEvent(Message):
    """What has changed in a node."""

    ros_type: ClassVar[str] = "rcl_interfaces/msg/ParameterEvent"

    stamp: Time
    node: str
    new_parameters: list[Parameter]
    changed_parameters: list[Parameter]
    deleted_parameters: list[Parameter]


class ListParametersRequest(Message):
    """No prefixes: all; depth 0: all below."""

    ros_type: ClassVar[str] = "rcl_interfaces/srv/ListParameters_Request"

    prefixes: list[str]
    depth: UInt64


class ListParametersResponse(Message):
    ros_type: ClassVar[str] = "rcl_interfaces/srv/ListParameters_Response"

    result: ListParametersResult


class DescribeParametersRequest(Message):
    ros_type: ClassVar[str] = "rcl_interfaces/srv/DescribeParameters_Request"

    names: list[str]


class DescribeParametersResponse(Message):
    ros_type: ClassVar[str] = "rcl_interfaces/srv/DescribeParameters_Response"

    descriptors: list[ParameterDescriptor]


class GetParametersRequest(Message):
    ros_type: ClassVar[str] = "rcl_interfaces/srv/GetParameters_Request"

    names: list[str]


class GetParametersResponse(Message):
    """One value for each name; NOT_SET where there is no such parameter."""

    ros_type: ClassVar[str] = "rcl_interfaces/srv/GetParameters_Response"

    values: list[ParameterValue]


class SetParametersRequest(Message):
    ros_type: ClassVar[str] = "rcl_interfaces/srv/SetParameters_Request"

    parameters: list[Parameter]


class SetParametersResponse(Message):
    """One result for each parameter."""

    ros_type: ClassVar[str] = "rcl_interfaces/srv/SetParameters_Response"

    results: list[SetParametersResult]
