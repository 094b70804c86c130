from typing import ClassVar

from zteleop.interfaces.comments import field_comments, type_comment
from zteleop.interfaces.foreign import struct_of
from zteleop.interfaces.schema import schema
from zteleop.messages import Message, Time, Vehicle


class Pot(Message):
    ros_type: ClassVar[str] = "garden_msgs/msg/Pot"

    size: float
    """m
    across"""
    full: bool


def test_a_class_says_what_it_is_and_a_base_does_not_speak_for_it() -> None:
    assert type_comment(Time) == "Seconds and nanoseconds since 1970."
    assert type_comment(Pot) == ""


def test_the_text_below_a_field_is_its_own() -> None:
    assert field_comments(Pot) == {"size": "m\nacross"}
    assert field_comments(Vehicle)["tick_us"] == "us of one count of the chip."


def test_a_type_from_the_bus_has_no_source() -> None:
    assert field_comments(struct_of(schema(Vehicle, Vehicle.ros_type))) == {}
