import ast
from typing import Any

import pytest

from zteleop.errors import MessageError
from zteleop.text.expression import value

M = {"x": 2.0, "n": 7, "name": "base", "data": [3, 1, 2], "inner": {"flag": False, "none": None}}


def of(text: str) -> Any:
    return value(ast.parse(text, mode="eval").body, M)


@pytest.mark.parametrize(
    ("text", "result"),
    [
        ("m.x", 2.0),
        ("m.data[0]", 3),
        ("m.data[-1]", 2),
        ("m['inner']['flag']", False),
        ("m.data[m.data[1]]", 1),
        ("m.x + m.n * 2 - 1", 15.0),
        ("m.n // 2 % 2", 1),
        ("m.n / 2", 3.5),
        ("-m.x + +1", -1.0),
        ("True + 1", 2),
        ("1 < m.x < 3", True),
        ("1 < m.x > 3", False),
        ("3 < m.x < 1 / 0", False),
        ("m.x == 2 and m.n != 7", False),
        ("m.x == 2 or 1 / 0", True),
        ("m.x and m.n", 7),
        ("'' or 'b'", "b"),
        ("not m.inner.flag", True),
        ("m.inner.none is None", True),
        ("m.x is not None", True),
        ("m.name in ('base', 'map')", True),
        ("m.name not in ['base']", False),
        ("'as' in m.name", True),
        ("1 in m.data", True),
        ("abs(-m.n)", 7),
        ("len(m.data) + len(m.name)", 7),
        ("max(m.data) - min(m.data)", 2),
        ("max(m.x, m.n)", 7),
        ("round(m.x / 3, 2)", 0.67),
        ("round(2.5)", 2),
        ("m.x <= 2 and m.x >= 2", True),
    ],
)
def test_it_comes_to_what_python_says(text: str, result: object) -> None:
    found = of(text)
    assert found == result
    assert type(found) is type(result)


@pytest.mark.parametrize(
    ("text", "error", "words"),
    [
        ("m.y", MessageError, "m has no field 'y'"),
        ("m.inner.x", MessageError, "m.inner has no field 'x'"),
        ("m.data[9]", MessageError, "m.data has 3 items"),
        ("m.name[0]", MessageError, "m.name is no list"),
        ("m.data[True]", TypeError, "an item is taken by its number"),
        ("m.data[m]", TypeError, "not by a dict"),
        ("m.data[1.0]", TypeError, "not by a float"),
        ("m.name * 1000000000", TypeError, "calculating needs numbers, not a str"),
        ("m.data * 1000000000", TypeError, "not a list"),
        ("'%1000000000d' % 1", TypeError, "not a str"),
        ("m.name + 'a'", TypeError, "not a str"),
        ("-m.name", TypeError, "not a str"),
        ("m.x / 0", ZeroDivisionError, "zero"),
        ("m.name < 1", TypeError, "not supported"),
        ("round(1, -10000000000)", ValueError, "at most 300 digits"),
        ("round(m.name)", TypeError, "not a str"),
        (f"{'9' * 400} * {'9' * 400} * 2", OverflowError, "grows too large"),
    ],
)
def test_what_comes_to_nothing_is_an_error(text: str, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        of(text)
