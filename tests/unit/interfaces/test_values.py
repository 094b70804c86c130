import datetime

import pytest

from zteleop.errors import MessageError
from zteleop.interfaces.values import fill
from zteleop.messages import (
    MESSAGES,
    Bool,
    Header,
    Int16MultiArray,
    Message,
    MultiArrayDimension,
    MultiArrayLayout,
    Odometry,
    SetBoolRequest,
    String,
    Time,
    Twist,
    TwistStamped,
    Vector3,
)


@pytest.mark.parametrize("values", [None, {}])
def test_nothing_said_is_all_zero(values: object) -> None:
    for kind in MESSAGES.values():
        assert fill(kind, values) == kind.zero()


def test_what_is_not_said_is_zero() -> None:
    assert fill(Twist, {"linear": {"x": 2}}) == Twist.planar(2.0)
    stamped = fill(TwistStamped, {"header": {"frame_id": "base_link"}, "twist": {"angular": {"z": 0.5}}})
    assert stamped == TwistStamped(Header(Time(0, 0), "base_link"), Twist.planar(0.0, 0.5))


def test_whole_numbers_become_floats() -> None:
    assert type(fill(Vector3, {"x": 1}).x) is float


def test_lists_are_taken_as_they_are() -> None:
    assert fill(Int16MultiArray, {"data": [390, 370]}).data == [390, 370]
    assert fill(Odometry, {"pose": {"covariance": [1.0] * 36}}).pose.covariance == [1.0] * 36


def test_what_is_not_said_in_a_lists_items_is_zero_too() -> None:
    """As with `ros2 topic pub`."""
    filled = fill(Int16MultiArray, {"layout": {"dim": [{"label": "axes"}]}})
    assert filled == Int16MultiArray(MultiArrayLayout([MultiArrayDimension("axes", 0, 0)], 0), [])


def test_the_values_given_stay_as_they_were() -> None:
    values = {"linear": {"x": 1}}
    fill(Twist, values)
    assert values == {"linear": {"x": 1}}


@pytest.mark.parametrize(
    ("kind", "values", "words"),
    [
        (Twist, {"liner": {"x": 1}}, "Twist has no field 'liner'; did you mean linear?"),
        (Twist, {"linear": {"w": 1}}, "Twist.linear has no field 'w'; known: x, y, z"),
        (Twist, {1: 2}, "Twist has no field 1; known: linear, angular"),
        (TwistStamped, {"twist": {"linear": 1}}, "expected {x, y, z} at TwistStamped.twist.linear, found 1"),
        (
            Twist,
            [1, 2],
            "expected {linear, angular} at Twist, found [1, 2]; name what is meant, as in {linear: {x: 0.0}}",
        ),
        (SetBoolRequest, True, "expected {data} at SetBoolRequest, found True; name what is meant, as in {"),
        (Twist, {"linear": {"x": 0, 2: None}}, "Twist.linear has no field 2; a decimal point is a point, no"),
        (Twist, {"linear": {2: 1}}, "Twist.linear has no field 2; known: x, y, z"),
        (Twist, {"linear": None}, "expected {x, y, z} at Twist.linear, found None"),
        (Twist, {"linear": {"x": "1"}}, "not a Twist: Expected `float`, got `str` - at `$.linear.x`"),
        (Twist, {"linear": {"x": True}}, "not a Twist: Expected `float`, got `bool` - at `$.linear.x`"),
        (Twist, {"linear": {"x": 10**400}}, "not a Twist: Number out of range - at `$.linear.x`"),
        (String, {"data": 5}, "not a String: Expected `str`, got `int` - at `$.data`"),
        (String, {"data": datetime.date(2024, 1, 1)}, "not a String: "),
        (String, {"data": b"x"}, "not a String: "),
        (Bool, {"data": 1}, "not a Bool: Expected `bool`, got `int` - at `$.data`"),
        (
            Int16MultiArray,
            {"data": [40000]},
            "not a Int16MultiArray: Expected `int` <= 32767 - at `$.data[",
        ),
        (Int16MultiArray, {"data": 5}, "not a Int16MultiArray: Expected `array`, got `int` - at `$.data`"),
        (Odometry, {"pose": {"covariance": []}}, "not a Odometry: Expected `array` of length >= 36"),
    ],
)
def test_what_does_not_fit_is_refused_with_its_path(kind: type[Message], values: object, words: str) -> None:
    with pytest.raises(MessageError) as error:
        fill(kind, values)
    assert str(error.value).startswith(words)


def test_a_list_within_itself_is_refused() -> None:
    endless: list[object] = []
    endless.append(endless)
    for values in ({"data": endless}, {"layout": {"dim": endless}}):
        with pytest.raises(MessageError):
            fill(Int16MultiArray, values)


def test_half_a_character_is_an_error_in_words() -> None:
    with pytest.raises(MessageError, match=r"not a Bool: .*surrogates not allowed"):
        fill(Bool, {"data": "\ud800"})
