from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.errors import MessageError
from zteleop.interfaces.parameters import fit, from_python, kind_of, sentence, to_python, type_words
from zteleop.messages import ParameterValue

VALUES = [
    (True, ParameterValue.BOOL, "Boolean value is: True"),
    (3, ParameterValue.INTEGER, "Integer value is: 3"),
    (0.5, ParameterValue.DOUBLE, "Double value is: 0.5"),
    ("a", ParameterValue.STRING, "String value is: a"),
    ([True, False], ParameterValue.BOOL_ARRAY, "Boolean values are: [True, False]"),
    ([1, 2], ParameterValue.INTEGER_ARRAY, "Integer values are: [1, 2]"),
    ([1.5], ParameterValue.DOUBLE_ARRAY, "Double values are: [1.5]"),
    (["a", "b"], ParameterValue.STRING_ARRAY, "String values are: ['a', 'b']"),
    ([], ParameterValue.STRING_ARRAY, "String values are: []"),
]
PLAIN = st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False) | st.text(max_size=5)


@pytest.mark.parametrize(("value", "kind", "words"), VALUES)
def test_a_value_travels_as_its_type_and_is_said_as_ros_says_it(value: Any, kind: int, words: str) -> None:
    told = from_python(value)
    assert (kind_of(value), told.type) == (kind, kind)
    assert to_python(told) == value
    assert sentence(told) == words


def test_what_is_not_set_is_said_as_such() -> None:
    assert to_python(ParameterValue.zero()) is None
    assert sentence(ParameterValue.zero()) == "Parameter not set."
    assert (type_words(0), type_words(3), type_words(8)) == ("not set", "double", "double array")


@pytest.mark.parametrize("value", [None, {}, [[1]], [1, "a"], [True, 1], b"x", object()])
def test_what_is_no_value_is_refused(value: Any) -> None:
    with pytest.raises(MessageError, match="a parameter is a truth value, number, text or a list"):
        from_python(value)


@pytest.mark.parametrize(
    ("value", "kind", "found"),
    [
        (1, ParameterValue.DOUBLE, 1.0),
        ([1, 2], ParameterValue.DOUBLE_ARRAY, [1.0, 2.0]),
        ([1, 2.5], ParameterValue.DOUBLE_ARRAY, [1, 2.5]),
        ([], ParameterValue.INTEGER_ARRAY, []),
        (2, ParameterValue.INTEGER, 2),
    ],
)
def test_a_whole_number_is_a_double_too(value: Any, kind: int, found: Any) -> None:
    assert fit(value, kind) == found
    assert type(fit(value, kind)) is type(found)


@pytest.mark.parametrize(
    ("value", "kind", "words"),
    [
        (1.5, ParameterValue.INTEGER, "expected integer, such as 3, found 1.5"),
        (True, ParameterValue.INTEGER, "expected integer, such as 3, found True"),
        (True, ParameterValue.DOUBLE, "expected double, such as 0.3, found True"),
        ("1", ParameterValue.DOUBLE, "expected double, such as 0.3, found '1'"),
        ([1.5], ParameterValue.INTEGER_ARRAY, r"expected integer array, such as \[1, 2\], found \[1.5\]"),
        ([], ParameterValue.INTEGER, r"expected integer, such as 3, found \[\]"),
    ],
)
def test_a_value_of_another_type_is_refused(value: Any, kind: int, words: str) -> None:
    with pytest.raises(MessageError, match=words):
        fit(value, kind)


@given(PLAIN | st.lists(st.floats(allow_nan=False) | st.integers(-(2**53), 2**53), min_size=1))
def test_any_value_comes_back(value: Any) -> None:
    assert to_python(from_python(value)) == value
