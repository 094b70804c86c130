"""Motion and place, in metres, radians and seconds (REP-103, geometry_msgs)."""

from typing import Annotated, ClassVar

from msgspec import Meta

from zteleop.errors import MessageError
from zteleop.messages.message import Message
from zteleop.messages.std import Header

Covariance = Annotated[list[float], Meta(min_length=36, max_length=36)]


class Vector3(Message, gc=False):
    """x forward, y left, z up."""

    ros_type: ClassVar[str] = "geometry_msgs/msg/Vector3"

    x: float
    y: float
    z: float


class Twist(Message):
    """Velocity of base_link: linear in m/s, angular in rad/s."""

    ros_type: ClassVar[str] = "geometry_msgs/msg/Twist"

    linear: Vector3
    angular: Vector3

    @classmethod
    def planar(cls, linear: float = 0.0, angular: float = 0.0) -> "Twist":
        """Return the twist of a ground robot in m/s and rad/s; a positive angular turns to the left.

        Raises MessageError for what is no number.
        """
        try:
            return cls(Vector3(float(linear), 0.0, 0.0), Vector3(0.0, 0.0, float(angular)))
        except (TypeError, ValueError):
            found = f"linear={linear!r:.40}, angular={angular!r:.40}"
            raise MessageError(f"expected numbers, in m/s and rad/s, found {found}") from None

    @property
    def moves(self) -> bool:
        """Whether a ground robot moves by it."""
        return self.linear.x != 0 or self.angular.z != 0


class TwistStamped(Message):
    ros_type: ClassVar[str] = "geometry_msgs/msg/TwistStamped"

    header: Header
    twist: Twist


class Point(Message, gc=False):
    ros_type: ClassVar[str] = "geometry_msgs/msg/Point"

    x: float
    y: float
    z: float


class Quaternion(Message, gc=False):
    ros_type: ClassVar[str] = "geometry_msgs/msg/Quaternion"

    x: float
    y: float
    z: float
    w: float


class Pose(Message):
    ros_type: ClassVar[str] = "geometry_msgs/msg/Pose"

    position: Point
    orientation: Quaternion


class PoseWithCovariance(Message):
    ros_type: ClassVar[str] = "geometry_msgs/msg/PoseWithCovariance"

    pose: Pose
    covariance: Covariance


class TwistWithCovariance(Message):
    ros_type: ClassVar[str] = "geometry_msgs/msg/TwistWithCovariance"

    twist: Twist
    covariance: Covariance


class PoseStamped(Message):
    ros_type: ClassVar[str] = "geometry_msgs/msg/PoseStamped"

    header: Header
    pose: Pose


class Transform(Message):
    ros_type: ClassVar[str] = "geometry_msgs/msg/Transform"

    translation: Vector3
    rotation: Quaternion


class TransformStamped(Message):
    """Where `child_frame_id` is, in `header.frame_id`."""

    ros_type: ClassVar[str] = "geometry_msgs/msg/TransformStamped"

    header: Header
    child_frame_id: str
    transform: Transform
