import pytest

from zteleop.messages import Bool, CompressedImage, Header, Int16MultiArray, Message, String, Time, Twist
from zteleop.text.ros_repr import ros_repr


@pytest.mark.parametrize(
    ("message", "text"),
    [
        (
            Twist.planar(0.0, 0.5),
            "geometry_msgs.msg.Twist(linear=geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=0.0), "
            "angular=geometry_msgs.msg.Vector3(x=0.0, y=0.0, z=0.5))",
        ),
        (Bool(True), "std_msgs.msg.Bool(data=True)"),
        (String("it's\n"), 'std_msgs.msg.String(data="it\'s\\n")'),
        (
            Header(Time(1, 2), ""),
            "std_msgs.msg.Header(stamp=builtin_interfaces.msg.Time(sec=1, nanosec=2), frame_id='')",
        ),
    ],
)
def test_a_message_is_written_as_ros_writes_it(message: Message, text: str) -> None:
    assert ros_repr(message) == text


def test_lists_are_plain_and_hold_messages() -> None:
    array = Int16MultiArray.zero()
    array.data = [390, 370]
    assert ros_repr(array).endswith("MultiArrayLayout(dim=[], data_offset=0), data=[390, 370])")
    assert ros_repr([Bool(False)]) == "[std_msgs.msg.Bool(data=False)]"


def test_bytes_are_numbers() -> None:
    image = CompressedImage(Header.zero(), "jpeg", b"\xff\xd8")
    assert ros_repr(image).endswith("format='jpeg', data=[255, 216])")
