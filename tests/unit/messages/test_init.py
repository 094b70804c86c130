import re

import pytest

import zteleop.messages
from zteleop.errors import MessageError
from zteleop.messages import MESSAGES, Message, Twist, TwistStamped, message_type


def subclasses(kind: type) -> set[type]:
    return {sub for direct in kind.__subclasses__() for sub in {direct, *subclasses(direct)}}


def test_the_table_holds_every_message() -> None:
    ours = {kind for kind in subclasses(Message) if kind.__module__.startswith("zteleop.messages.")}
    assert set(MESSAGES.values()) == ours
    assert all(getattr(zteleop.messages, kind.__name__) is kind for kind in ours)


@pytest.mark.parametrize(("name", "kind"), MESSAGES.items(), ids=MESSAGES)
def test_each_stands_under_the_name_that_ros_gives_it(name: str, kind: type[Message]) -> None:
    assert name == kind.ros_type
    assert re.fullmatch(rf"[a-z]+(_[a-z]+)*/msg/{kind.__name__}", name)


@pytest.mark.parametrize("name", ["geometry_msgs/msg/Twist", "geometry_msgs/Twist", "Twist"])
def test_a_type_is_found_by_any_of_its_names(name: str) -> None:
    assert message_type(name) is Twist


def test_a_leaf_is_the_whole_leaf() -> None:
    assert message_type("TwistStamped") is TwistStamped


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("Twst", "no message type 'Twst'; did you mean Twist"),
        ("geometry_msgs/msg/Odometri", "did you mean Odometry"),
        ("std_msgs/msg/Twist", "no message type 'std_msgs/msg/Twist'; did you mean Twist"),
        ("geometry/Twist", "no message type 'geometry/Twist'"),
        ("wist", "did you mean Twist"),
        ("xyz", "known: builtin_interfaces/msg/Time, "),
        ("", "no message type ''; known: "),
        ("geometry_msgs/msg/", "known: "),
    ],
)
def test_an_unknown_type_is_refused_with_the_nearest(name: str, words: str) -> None:
    with pytest.raises(MessageError) as error:
        message_type(name)
    assert words in str(error.value)
