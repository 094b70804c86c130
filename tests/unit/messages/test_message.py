from typing import Annotated, Any, Literal

import msgspec
import pytest
from msgspec import Meta

from zteleop.messages import MESSAGES, DriveStatus, Header, Odometry, Time, Twist, Vector3
from zteleop.messages.message import field_types, zero_of


def test_the_zero_of_every_type_is_a_message_of_it() -> None:
    for kind in MESSAGES.values():
        assert msgspec.convert(msgspec.to_builtins(kind.zero()), kind, strict=True) == kind.zero()


def test_no_field_has_a_default_so_that_nothing_is_silently_zero() -> None:
    for kind in MESSAGES.values():
        assert kind.__struct_defaults__ == (), kind.__name__
        if kind.__struct_fields__:
            with pytest.raises(msgspec.ValidationError, match="missing required field"):
                msgspec.convert({}, kind)


def test_zero_is_every_number_0_and_every_text_and_list_empty() -> None:
    status = DriveStatus.zero()
    assert (status.state, status.why, status.pulses, status.seq, status.written) == (
        "starting",
        "",
        [],
        0,
        0.0,
    )
    assert status.wanted == Twist(Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0))
    assert Header.zero() == Header(Time(0, 0), "")


def test_a_covariance_is_36_zeros() -> None:
    odom = Odometry.zero()
    assert odom.pose.covariance == odom.twist.covariance == [0.0] * 36
    assert {type(number) for number in odom.pose.covariance} == {float}


@pytest.mark.parametrize("length", [35, 37])
def test_a_covariance_of_another_length_is_refused(length: int) -> None:
    values = msgspec.to_builtins(Odometry.zero())
    values["pose"]["covariance"] = [0.0] * length
    with pytest.raises(msgspec.ValidationError, match="36"):
        msgspec.convert(values, Odometry)


def test_two_zeros_share_nothing() -> None:
    first, second = Odometry.zero(), Odometry.zero()
    first.pose.covariance[0] = first.pose.pose.position.x = 1.0
    assert second == Odometry.zero()


@pytest.mark.parametrize(
    ("annotation", "zero"),
    [
        (int, 0),
        (float, 0.0),
        (bool, False),
        (str, ""),
        (bytes, b""),
        (list[int], []),
        (Annotated[int, Meta(ge=0)], 0),
        (Annotated[list[int], Meta(min_length=2, max_length=2)], [0, 0]),
        (Literal["a", "b"], "a"),
        (float | None, None),
        (Time, Time(0, 0)),
    ],
)
def test_each_kind_of_field_has_its_zero(annotation: Any, zero: object) -> None:
    assert zero_of(annotation) == zero
    assert type(zero_of(annotation)) is type(zero)


def test_fields_are_in_order_with_their_bounds() -> None:
    assert list(field_types(DriveStatus)) == list(DriveStatus.__struct_fields__)
    assert msgspec.convert(0, field_types(Time)["nanosec"]) == 0
    with pytest.raises(msgspec.ValidationError):
        msgspec.convert(-1, field_types(Time)["nanosec"])


@pytest.mark.parametrize(
    ("kind", "zero"),
    [
        (bytes, b""),
        (Annotated[bytes, Meta(min_length=4, max_length=4)], bytes(4)),
        (Annotated[bytes, Meta(max_length=4)], b""),
        (Annotated[list[float], Meta(min_length=2, max_length=2)], [0.0, 0.0]),
    ],
)
def test_the_zero_of_bytes_is_as_long_as_they_must_be(kind: Any, zero: Any) -> None:
    assert zero_of(kind) == zero
