import json

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.errors import MessageError
from zteleop.messages import Header, Time, Twist, TwistStamped
from zteleop.text import paths

STAMPED = msgspec.to_builtins(TwistStamped(Header(Time(1, 2), "base_link"), Twist.planar(0.5, 1.0)))
NAMES = st.text("abz_", min_size=1, max_size=6)
PLAIN = st.recursive(
    st.none() | st.booleans() | st.integers() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(NAMES, inner),
    max_leaves=10,
)


@pytest.mark.parametrize(
    ("text", "path"),
    [
        ("twist", ("twist",)),
        ("twist.linear.x", ("twist", "linear", "x")),
        ("data[0]", ("data", 0)),
        ("layout.dim[-1].label", ("layout", "dim", -1, "label")),
        ("[3][4]", (3, 4)),
        (".twist..linear.", ("twist", "linear")),
    ],
)
def test_a_path_is_names_and_numbers(text: str, path: paths.Path) -> None:
    assert paths.parse(text) == path
    assert paths.parse(paths.named(path)) == path


@pytest.mark.parametrize(
    "text", ["", ".", "data[", "data]", "data[x]", "data[0", "a[1.5]", "a[9999999999]", "]["]
)
def test_what_is_no_path_is_refused(text: str) -> None:
    with pytest.raises(MessageError, match=r"Invalid field value .* such as twist\.linear\.x or data"):
        paths.parse(text)


@pytest.mark.parametrize(
    ("text", "value"),
    [("twist.linear.x", 0.5), ("header.stamp", {"sec": 1, "nanosec": 2}), ("header.frame_id", "base_link")],
)
def test_a_path_leads_to_a_value(text: str, value: object) -> None:
    assert paths.value_at(STAMPED, paths.parse(text)) == value


def test_items_are_counted_from_either_end() -> None:
    assert paths.value_at({"data": [1, 2, 3]}, ("data", 0)) == 1
    assert paths.value_at({"data": [1, 2, 3]}, ("data", -1)) == 3


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("twits", "Invalid field 'twits': Twist has no field 'twits'; did you mean twist?"),
        (
            "twist.linaer",
            "Invalid field 'twist.linaer': Twist.twist has no field 'linaer'; did you mean twist.linear",
        ),
        ("angular.z", "Twist has no field 'angular'; did you mean twist.angular.z?"),
        ("zzz", "Twist has no field 'zzz'; known: header, twist"),
        ("header.frame_id.x", "Twist.header.frame_id has no field 'x'; it has no fields"),
        ("twist.linear.x.y", "Twist.twist.linear.x has no field 'y'; it has no fields"),
        ("twist[0]", "Twist.twist is no list; there is no [0]"),
    ],
)
def test_a_path_that_leads_nowhere_is_told_the_nearest(text: str, words: str) -> None:
    with pytest.raises(MessageError) as error:
        paths.check(STAMPED, paths.parse(text), "Twist")
    assert words in str(error.value)
    with pytest.raises(MessageError):
        paths.value_at(STAMPED, paths.parse(text))


def test_an_item_beyond_the_end_is_refused_with_the_number_of_items() -> None:
    for index in (2, -3):
        with pytest.raises(MessageError, match=r"the message\.data has 2 items"):
            paths.value_at({"data": [1, 2]}, ("data", index))


def test_what_an_empty_list_or_a_null_would_hold_may_be_asked_for() -> None:
    paths.check({"data": []}, ("data", 5, "x"), "A")
    paths.check({"data": None}, ("data", "x"), "A")
    with pytest.raises(MessageError):
        paths.value_at({"data": []}, ("data", 5))


def test_a_field_of_a_list_needs_an_item() -> None:
    with pytest.raises(MessageError, match=r"A.data has no field 'x'; of a list say which item: \[0\]"):
        paths.check({"data": [{"x": 1}]}, ("data", "x"), "A")


def test_nearest_names_are_sought_in_the_items_of_lists() -> None:
    with pytest.raises(MessageError, match=r"did you mean pulses\[0\].duty_ticks"):
        paths.check({"pulses": [{"duty_ticks": 1}]}, ("pulses", 0, "duty_tick"), "A")


def test_a_large_message_is_not_searched_for_ever() -> None:
    large = {f"field_{number}": {"a": number} for number in range(100_000)}
    with pytest.raises(MessageError) as error:
        paths.check(large, ("feld",), "A")
    assert len(str(error.value)) < 1000


def test_leaves_are_all_that_has_nothing_within_it_in_order() -> None:
    assert list(paths.leaves({"a": {"x": 1, "y": "z"}, "b": [1, [2]], "c": [], "d": {}, "e": None})) == [
        ("a.x", 1),
        ("a.y", "z"),
        ("b[0]", 1),
        ("b[1][0]", 2),
        ("c", []),
        ("d", {}),
        ("e", None),
    ]


@given(st.dictionaries(NAMES, PLAIN, min_size=1, max_size=3))
def test_each_leaf_is_found_by_its_name(values: object) -> None:
    found = list(paths.leaves(values))
    assert found
    for name, value in found:
        assert paths.value_at(values, paths.parse(name)) == value
        paths.check(values, paths.parse(name), "A")


@given(st.text(max_size=30), PLAIN)
def test_any_text_is_a_path_or_refused(text: str, values: object) -> None:
    try:
        path = paths.parse(text)
        assert paths.parse(paths.named(path)) == path
        json.dumps(paths.value_at(values, path))
    except MessageError:
        return


def test_a_path_of_any_length_is_refused_in_a_few_words() -> None:
    with pytest.raises(MessageError) as error:
        paths.parse("a" + ".a" * 100_000)
    assert str(error.value) == "a field has at most 1000 characters, found 200001"


def test_bytes_have_items() -> None:
    image = {"data": b"\xff\xd8"}
    assert paths.value_at(image, ("data", 1)) == 0xD8
    paths.check({"data": b""}, ("data", 1), "A")
    with pytest.raises(MessageError, match=r"A\.data has 2 items; there is no \[2\]"):
        paths.value_at(image, ("data", 2), "A")
    with pytest.raises(MessageError, match="of a list say which item"):
        paths.check(image, ("data", "x"), "A")
