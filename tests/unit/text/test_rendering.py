from typing import Annotated, Any, ClassVar

import msgspec
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from msgspec import Meta

from zteleop.messages import Int16MultiArray, Log, Message, MultiArrayLayout, Odometry, Twist
from zteleop.messages.std import Int8, Time, UInt8, UInt64
from zteleop.text.rendering import CUT, Style, csv_line, shorten, to_yaml

ALL = Style(longest=None)


class Mixed(Message):
    ros_type: ClassVar[str] = "acme_msgs/msg/Mixed"

    flags: list[bool]
    texts: list[str]
    bytes_: list[UInt8]
    small: list[Int8]
    large: list[UInt64]
    plain: list[int]
    bounded: Annotated[list[float], Meta(max_length=5)]
    three: Annotated[list[Time], Meta(min_length=3, max_length=3)]


def test_what_is_short_stays_as_it_is() -> None:
    values = msgspec.to_builtins(Odometry.zero())
    assert shorten(values, Style(), Odometry) == values


def test_what_is_long_is_cut_and_says_so() -> None:
    values = {"data": [*range(200)], "name": "x" * 200}
    short = shorten(values, Style())
    assert short == {"data": [*range(CUT), "..."], "name": "x" * CUT + "..."}
    assert shorten(values, ALL) == values
    assert shorten(values, Style(longest=0)) == {"data": ["..."], "name": "..."}
    assert shorten({"data": [1] * CUT}, Style()) == {"data": [1] * CUT}


def test_items_are_cut_too() -> None:
    assert shorten([["abc"], [1, 2, 3]], Style(longest=2)) == [["ab..."], [1, 2, "..."]]


def test_bytes_are_numbers() -> None:
    assert shorten({"data": b"\x01\x02\x03"}, Style(longest=2)) == {"data": [1, 2, "..."]}
    assert shorten({"data": b"\x01"}, Style(no_arrays=True)) == {"data": "<sequence type: uint8, length: 1>"}


def test_instead_of_a_text_its_length() -> None:
    assert shorten({"data": "Hello World: 1"}, Style(no_strings=True)) == {"data": "<string length: <14>>"}


@pytest.mark.parametrize(
    ("kind", "field", "text"),
    [
        (Int16MultiArray, "data", "<sequence type: int16, length: 0>"),
        (MultiArrayLayout, "dim", "<sequence type: std_msgs/msg/MultiArrayDimension, length: 0>"),
        (Mixed, "flags", "<sequence type: boolean, length: 0>"),
        (Mixed, "texts", "<sequence type: string, length: 0>"),
        (Mixed, "bytes_", "<sequence type: uint8, length: 0>"),
        (Mixed, "small", "<sequence type: int8, length: 0>"),
        (Mixed, "large", "<sequence type: uint64, length: 0>"),
        (Mixed, "plain", "<sequence type: int64, length: 0>"),
        (Mixed, "bounded", "<sequence type: double[5], length: 0>"),
        (Mixed, "three", "<array type: builtin_interfaces/msg/Time[3]>"),
    ],
)
def test_instead_of_an_array_its_type(kind: type[Message], field: str, text: str) -> None:
    values = msgspec.to_builtins(kind.zero())
    assert shorten(values, Style(no_arrays=True), kind)[field] == text


@pytest.mark.parametrize(
    ("value", "name"),
    [([1.0], "double"), ([True], "boolean"), (["a"], "string"), ([], "unknown"), ([{}], "unknown")],
)
def test_of_an_array_nobody_knows_the_type_is_that_of_its_first_item(value: list[Any], name: str) -> None:
    assert shorten(value, Style(no_arrays=True)) == f"<sequence type: {name}, length: {len(value)}>"


def test_a_message_is_yaml_in_its_own_order() -> None:
    assert to_yaml(msgspec.to_builtins(Twist.planar(0.5))) == (
        "linear:\n  x: 0.5\n  y: 0.0\n  z: 0.0\nangular:\n  x: 0.0\n  y: 0.0\n  z: 0.0\n"
    )
    log = to_yaml(msgspec.to_builtins(Log.zero()))
    assert log.startswith("stamp:\n  sec: 0\n  nanosec: 0\nlevel: 0\nname: ''\n")


def test_a_long_text_stays_on_its_line() -> None:
    assert to_yaml({"a": "word " * 100 + "end"}).count("\n") == 1


def test_a_message_can_be_one_line() -> None:
    assert to_yaml({"a": {"x": 1.0}, "b": []}, flow=True) == "{a: {x: 1.0}, b: []}\n"


@pytest.mark.parametrize(
    ("value", "text"), [(0.0, "0.0\n"), ("idle", "idle\n"), (True, "True\n"), ("", "\n")]
)
def test_a_plain_value_is_its_text(value: object, text: str) -> None:
    assert to_yaml(value) == text


def test_what_is_there_twice_is_written_twice() -> None:
    part = {"x": [1]}
    assert "&" not in to_yaml({"a": part, "b": part})


def test_a_row_is_quoted_where_it_must_be() -> None:
    assert csv_line([1, 0.0, True, "", None, [], {}, "a,b", 'say "x"']) == '1,0.0,True,,,,,"a,b","say ""x"""'


@given(
    st.dictionaries(
        st.text(max_size=5), st.floats(allow_nan=False) | st.booleans() | st.integers() | st.text(max_size=9)
    )
)
def test_yaml_can_be_read_back(values: dict[str, Any]) -> None:
    assert yaml.safe_load(to_yaml(values)) == values
