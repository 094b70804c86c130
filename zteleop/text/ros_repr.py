"""A message as Python shows ROS's own: `std_msgs.msg.String(data='hello')`."""

from typing import Any

from zteleop.messages import Message


def ros_repr(value: Any) -> str:
    """Return a message, with all that is in it, as `rclpy` programs print it."""
    if isinstance(value, Message):
        fields = ", ".join(f"{name}={ros_repr(getattr(value, name))}" for name in value.__struct_fields__)
        return f"{value.ros_type.replace('/', '.')}({fields})"
    if isinstance(value, list | bytes):
        return f"[{', '.join(map(ros_repr, value))}]"
    return repr(value)
