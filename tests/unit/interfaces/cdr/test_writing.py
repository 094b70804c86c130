from array import array
from typing import Any

import pytest

from zteleop.errors import MessageError
from zteleop.interfaces import cdr, ros2msg
from zteleop.messages import (
    Bool,
    Header,
    Int16MultiArray,
    MultiArrayLayout,
    Pwm,
    String,
    Time,
    Twist,
    Vector3,
)

LAYOUT = MultiArrayLayout([], 0)


@pytest.mark.parametrize(
    "message",
    [
        Time(2**31, 0),
        Time(0, -1),
        Time(1.5, 0),  # type: ignore[arg-type]
        Time(None, 0),  # type: ignore[arg-type]
        String(3),  # type: ignore[arg-type]
        String("\ud800"),
        Int16MultiArray(LAYOUT, [2**15]),
        Int16MultiArray(LAYOUT, None),  # type: ignore[arg-type]
        Int16MultiArray(LAYOUT, "abc"),  # type: ignore[arg-type]
        Int16MultiArray(None, []),  # type: ignore[arg-type]
        Twist(Vector3(0.0, 0.0, 0.0), String("")),  # type: ignore[arg-type]
        Header(Time(0, 0), b"x"),  # type: ignore[arg-type]
        Vector3("1", 0.0, 0.0),  # type: ignore[arg-type]
        Pwm(10**30, 0),
    ],
    ids=repr,
)
def test_what_has_no_place_in_a_message_is_refused(message: Any) -> None:
    with pytest.raises(MessageError, match=f"cannot write {type(message).__name__}"):
        cdr.encode(message)


@pytest.mark.parametrize("length", [0, 1, 3])
@pytest.mark.parametrize("array", ["uint8[2]", "float64[2]", "string[2]", "Part[2]"])
def test_an_array_of_another_length_is_refused(array: str, length: int) -> None:
    kind = ros2msg.struct_of("x/msg/Top", f"{array} items\n{'=' * 80}\nMSG: x/Part\nint8 x\n")
    items: Any = bytes(length) if array.startswith("uint8") else [0.0] * length
    with pytest.raises(MessageError, match=f"expected 2 items, found {length}"):
        cdr.encode(kind(items=items))  # type: ignore[call-arg]


@pytest.mark.parametrize(
    ("field", "value", "why"),
    [
        ("uint8[<=2]", b"abc", "at most 2 items, found 3"),
        ("float64[<=2]", [0.0] * 3, "at most 2 items, found 3"),
        ("string[<=1]", ["", ""], "at most 1 items, found 2"),
        ("string<=2", "abc", "at most 2 characters, found 3"),
        ("string<=2[]", ["abc"], "at most 2 characters, found 3"),
    ],
)
def test_more_than_a_type_may_hold_is_refused(field: str, value: Any, why: str) -> None:
    kind = ros2msg.struct_of("x/msg/Top", f"{field} items\n")
    with pytest.raises(MessageError, match=f"expected {why}"):
        cdr.encode(kind(items=value))  # type: ignore[call-arg]


def test_bytes_may_be_whatever_holds_bytes() -> None:
    kind = ros2msg.struct_of("x/msg/Top", "uint8[] items\nuint8 last\n")
    wanted = cdr.encode(kind(items=b"\1\2", last=3))  # type: ignore[call-arg]
    for items in ([1, 2], (1, 2), bytearray(b"\1\2"), memoryview(b"\1\2"), array("B", [1, 2])):
        assert cdr.encode(kind(items=items, last=3)) == wanted  # type: ignore[call-arg]
    for wrong in (2, "ab", [256], None, [-1], ["a"]):
        with pytest.raises(MessageError, match="cannot write Top"):
            cdr.encode(kind(items=wrong, last=3))  # type: ignore[call-arg]


def test_whatever_is_true_is_true() -> None:
    assert cdr.encode(Bool(7)) == cdr.encode(Bool(True))  # type: ignore[arg-type]


def test_a_tuple_or_an_array_is_as_good_as_a_list() -> None:
    wanted = cdr.encode(Int16MultiArray(LAYOUT, [1, 2]))
    assert cdr.encode(Int16MultiArray(LAYOUT, (1, 2))) == wanted  # type: ignore[arg-type]
