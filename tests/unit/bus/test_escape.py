import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.bus.escape import printable


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("\x1b[2J", "\\u001b[2J"),
        ("\x9b\u202e\x7f", "\\u009b\\u202e\\u007f"),
        ("\U000e0001", "\\udb40\\udc01"),
        ("Straße 東京 🚗", "Straße 東京 🚗"),
    ],
)
def test_what_could_steer_a_terminal_is_shown_as_json_writes_it(text: str, shown: str) -> None:
    assert printable(text) == shown


def test_line_ends_may_be_kept() -> None:
    assert printable("a\nb\r", keep="\n") == "a\nb\\u000d"


@given(st.text())
def test_json_stays_the_same_json(text: str) -> None:
    assert json.loads(printable(json.dumps(text, ensure_ascii=False))) == text


@given(st.text())
def test_nothing_is_left_that_cannot_be_printed(text: str) -> None:
    assert printable(text).isprintable()
