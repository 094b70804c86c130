import re

import pytest

import zteleop.messages
from zteleop.errors import MessageError
from zteleop.messages import (
    MESSAGES,
    SERVICES,
    Message,
    SetBoolRequest,
    SetBoolResponse,
    Twist,
    TwistStamped,
    message_type,
    service_type,
)


def subclasses(kind: type) -> set[type]:
    return {sub for direct in kind.__subclasses__() for sub in {direct, *subclasses(direct)}}


def test_the_table_holds_every_message() -> None:
    ours = {kind for kind in subclasses(Message) if kind.__module__.startswith("zteleop.messages.")}
    assert set(MESSAGES.values()) == ours
    assert all(getattr(zteleop.messages, kind.__name__) is kind for kind in ours)


def test_each_stands_under_the_name_that_ros_gives_it() -> None:
    wording = re.compile(r"[a-z0-9]+(_[a-z]+)*/(msg/[A-Za-z0-9]+|srv/[A-Za-z]+_(Request|Response))")
    for name, kind in MESSAGES.items():
        assert name == kind.ros_type
        assert name.rpartition("/")[2].replace("_", "") == kind.__name__
        assert wording.fullmatch(name)


def test_every_service_has_both_its_sides() -> None:
    for name, (request, response) in SERVICES.items():
        assert (request.ros_type, response.ros_type) == (f"{name}_Request", f"{name}_Response")
    sides = {kind for both in SERVICES.values() for kind in both}
    assert sides == {kind for name, kind in MESSAGES.items() if "/srv/" in name}


@pytest.mark.parametrize("name", ["std_srvs/srv/SetBool", "std_srvs/SetBool", "SetBool"])
def test_a_service_is_found_by_any_of_its_names(name: str) -> None:
    assert service_type(name) == (SetBoolRequest, SetBoolResponse)


def test_an_unknown_service_is_refused_with_the_nearest() -> None:
    with pytest.raises(MessageError, match="no service type 'SetBol'; did you mean std_srvs/srv/SetBool"):
        service_type("SetBol")


@pytest.mark.parametrize("name", ["geometry_msgs/msg/Twist", "geometry_msgs/Twist", "Twist"])
def test_a_type_is_found_by_any_of_its_names(name: str) -> None:
    assert message_type(name) is Twist


def test_a_leaf_is_the_whole_leaf() -> None:
    assert message_type("TwistStamped") is TwistStamped


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("Twst", "no message type 'Twst'; did you mean geometry_msgs/msg/Twist"),
        ("geometry_msgs/msg/Odometri", "did you mean nav_msgs/msg/Odometry"),
        ("std_msgs/msg/Twist", "no message type 'std_msgs/msg/Twist'; did you mean geometry_msgs/msg/Twist"),
        ("geometry/Twist", "no message type 'geometry/Twist'"),
        ("wist", "did you mean geometry_msgs/msg/Twist"),
        ("xyz", "known: builtin_interfaces/msg/Duration, "),
        ("", "no message type ''; known: "),
        ("geometry_msgs/msg/", "did you mean "),
    ],
)
def test_an_unknown_type_is_refused_with_the_nearest(name: str, words: str) -> None:
    with pytest.raises(MessageError) as error:
        message_type(name)
    assert words in str(error.value)
