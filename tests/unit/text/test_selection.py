from typing import Any

import msgspec
import pytest

from zteleop.errors import MessageError
from zteleop.messages import DriveStatus, Odometry, Twist, TwistStamped, Vector3
from zteleop.messages.geometry import Covariance
from zteleop.text.filter import Filter
from zteleop.text.paths import parse
from zteleop.text.selection import Selection, kind_at

TWIST = msgspec.to_builtins(Twist.planar(0.5, 1.0))


def test_without_wishes_everything_suits_and_is_whole() -> None:
    selection = Selection()
    selection.check_types([Twist, TwistStamped], "/abe/cmd_vel")
    selection.check_types([], "/abe/soil")
    selection.check([1, 2], "acme_msgs/msg/Soil", "/abe/soil")
    assert selection.wants(TWIST)
    assert list(selection.parts(TWIST)) == [("", TWIST)]


def test_fields_are_named_as_they_were_asked_for() -> None:
    selection = Selection(fields=(parse("angular.z"), parse("linear")))
    assert list(selection.parts(TWIST)) == [("angular.z", 1.0), ("linear", TWIST["linear"])]


@pytest.mark.parametrize("name", ["Twist", "geometry_msgs/Twist", "geometry_msgs/msg/Twist"])
def test_a_type_is_called_by_any_of_its_names(name: str) -> None:
    Selection(name).check(TWIST, "geometry_msgs/msg/Twist", "/abe/cmd_vel")
    Selection(name).check_types([TwistStamped, Twist], "/abe/cmd_vel")
    with pytest.raises(
        MessageError, match=f"/abe/odom carries nav_msgs/msg/Odometry, not {name}; say that type"
    ):
        Selection(name).check_types([Odometry], "/abe/odom")


@pytest.mark.parametrize(
    ("selection", "kinds", "words"),
    [
        (Selection(fields=(parse("linaer"),)), [Twist], "Twist has no field 'linaer'; did you mean linear?"),
        (Selection(fields=(parse("lin"),)), [TwistStamped, Twist], "TwistStamped has no field 'lin'"),
        (Selection(filter=Filter("m.linaer.x > 1")), [Twist], "filter: Invalid field 'linaer.x'"),
        (Selection("Twits"), [], "no message type 'Twits'; did you mean"),
        (Selection("geometry_msgs/msg/Twits"), [], "no message type 'geometry_msgs/msg/Twits'; did you mean"),
        (Selection("Twist", (parse("linaer"),)), [], "Twist has no field 'linaer'"),
    ],
)
def test_what_no_message_can_suit_is_refused_before_any_comes(
    selection: Selection, kinds: list[Any], words: str
) -> None:
    with pytest.raises(MessageError) as error:
        selection.check_types(kinds, "/abe/x")
    assert words in str(error.value)


def test_what_one_of_a_topics_types_suits_is_not() -> None:
    Selection(fields=(parse("angular.z"),)).check_types([TwistStamped, Twist], "/abe/cmd_vel")


def test_a_type_of_strangers_may_come_later() -> None:
    Selection("acme_msgs/msg/Soil", (parse("wet"),)).check_types([], "/abe/soil")


def test_a_filter_chooses() -> None:
    assert Selection(filter=Filter("m.linear.x > 0.2")).wants(TWIST)
    assert not Selection(filter=Filter("m.linear.x > 0.7")).wants(TWIST)


@pytest.mark.parametrize(
    ("ros_type", "name", "kind"),
    [
        ("geometry_msgs/msg/Twist", "", Twist),
        ("geometry_msgs/msg/Twist", "linear", Vector3),
        ("geometry_msgs/msg/Twist", "linear.x", float),
        ("nav_msgs/msg/Odometry", "pose.covariance", Covariance),
        ("zteleop_msgs/msg/DriveStatus", "pulses[0].name", None),
        ("zteleop_msgs/msg/DriveStatus", "", DriveStatus),
        ("acme_msgs/msg/Soil", "wet", None),
        ("acme_msgs/msg/Soil", "", None),
    ],
)
def test_the_type_of_a_field_is_known_where_its_message_is(ros_type: str, name: str, kind: Any) -> None:
    assert kind_at(ros_type, name) == kind
