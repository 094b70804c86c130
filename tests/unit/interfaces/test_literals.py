from math import isnan
from typing import Any

import pytest

from zteleop.errors import MessageError
from zteleop.interfaces.literals import constant, default, without_comment
from zteleop.interfaces.msg_text import Type, parse_type


def kind(text: str) -> Type:
    return parse_type(text, "garden_msgs")


@pytest.mark.parametrize(
    ("text", "code"),
    [
        ("5 # five", "5"),
        ("5", "5"),
        ("# five", ""),
        ("'#5' # five", "'#5'"),
        (r'"a\"#" # five', r'"a\"#"'),
        ("it's # five", "it's"),
        ("['#', \"'\"]#", "['#', \"'\"]"),
    ],
)
def test_a_comment_begins_outside_of_quotes(text: str, code: str) -> None:
    assert without_comment(text) == code


@pytest.mark.parametrize(
    ("type_text", "text", "value"),
    [
        ("bool", "True", True),
        ("bool", "0", False),
        ("int8", "-128", -128),
        ("uint8", "007", 7),
        ("byte", "0xff", 255),
        ("char", "65", 65),
        ("uint64", str(2**64 - 1), 2**64 - 1),
        ("float32", "1", 1.0),
        ("float64", "-1e3", -1000.0),
        ("string", "'two words'", "two words"),
        ("string", r'"say \"hi\""', 'say "hi"'),
        ("string", "two words", "two words"),
        ("string", '""', ""),
        ("wstring<=2", "'éé'", "éé"),
        ("int8[]", "[]", ()),
        ("int8[]", "[ 1,2 , 3]", (1, 2, 3)),
        ("bool[2]", "[true, false]", (True, False)),
        ("string[<=3]", "[\"a, b\", 'c', d]", ("a, b", "c", "d")),
    ],
)
def test_a_default_is_a_value_of_its_type(type_text: str, text: str, value: Any) -> None:
    found = default(text, kind(type_text))
    assert found == value
    assert type(found) is type(value)


def test_a_default_may_be_no_number_at_all() -> None:
    assert isnan(default("nan", kind("float64")))


@pytest.mark.parametrize(
    ("type_text", "text", "why"),
    [
        ("bool", "yes", "expected true or false, found 'yes'"),
        ("int8", "128", "expected a whole number from -128 to 127, found '128'"),
        ("uint8", "-1", "expected a whole number from 0 to 255"),
        ("byte", "256", "expected a whole number from 0 to 255"),
        ("int64", str(2**63), "expected a whole number from"),
        ("int32", "1.5", "expected a whole number from"),
        ("int32", "9" * 5000, "expected a whole number from"),
        ("float64", "1,5", "expected a number, found '1,5'"),
        ("string", "'abc", "ends with the quote it begins with"),
        ("string", '"a" b', "ends with the quote it begins with"),
        ("string<=2", "abc", "expected at most 2 characters, found 3"),
        ("int8[]", "1, 2", r"expected a default such as \[1, 2\]"),
        ("int8[]", "[", r"expected a default such as \[1, 2\]"),
        ("int8[]", "[1,,2]", "expected a whole number"),
        ("int8[3]", "[1, 2]", "expected a default of 3 values, found 2"),
        ("int8[<=1]", "[1, 2]", "expected a default of at most 1 values, found 2"),
    ],
)
def test_another_default_is_one_sentence(type_text: str, text: str, why: str) -> None:
    with pytest.raises(MessageError, match=why):
        default(text, kind(type_text))


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("'a' # b", "a"),
        ("a # b", "a # b"),
        ('"#a" are # b', '"#a" are # b'),
        ("it's", "it's"),
        ("", ""),
    ],
)
def test_a_text_without_quotes_goes_on_to_the_end_of_the_line(text: str, value: str) -> None:
    assert constant(text, kind("string")) == value


def test_a_number_does_not() -> None:
    assert constant("5 # five", kind("int8")) == 5
