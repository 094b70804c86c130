import time
from typing import Any

import msgspec
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from zteleop.errors import MessageError
from zteleop.messages import Header, Time, Twist, TwistStamped
from zteleop.text.filter import Filter

STAMPED = msgspec.to_builtins(TwistStamped(Header(Time(1, 2), "base_link"), Twist.planar(0.5, 1.0)))
PIECES = """
m m.twist .linear .x [0] ( ) , and or not == < > + - * ** / // % in is 1 0.5 'a' len( max( round( lambda :
[ ] { } if else for None True __class__ eval( import x & | ~ := @ << ... # \\
"""
WORDS = st.sampled_from([*PIECES.split(), " ", "\n", "\0"])


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("m.twist.linear.x > 0.2", True),
        ("m.twist.linear.x > 0.2 and m.header.frame_id == 'odom'", False),
        (" abs(m.twist.angular.z) >= 1\n", True),
        ("m.header", True),
        ("m.header.stamp.sec - 1", False),
    ],
)
def test_it_says_which_messages_are_wanted(text: str, wanted: bool) -> None:
    found = Filter(text)
    found.check(STAMPED, "TwistStamped")
    assert found.wants(STAMPED) is wanted


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "expected a filter such as"),
        ("m.x >", "expected a filter such as 'm.twist.linear.x > 0.2', found 'm.x >': "),
        ("m.x = 1", "expected a filter such as"),
        ("m.x == 1; m", "expected a filter such as"),
        ("\0", "expected a filter such as"),
        ("(" * 300, "expected a filter such as"),
        ("m." + "x" * 1000, "at most 1000 characters, found 1002"),
        ("-" * 500 + "1", "nested at most 50 deep"),
        ("m.x ** 2", r"cannot have \*\*"),
        ("m.x << 2", "cannot have <<"),
        ("m.x & 1", "say and, not &"),
        ("m.x | 1", "say or, not |"),
        ("~m.x", "say not, not ~"),
        ("x > 1", "the filter has no 'x'; did you mean m.x?"),
        ("m.x == true", "did you mean True?"),
        ("m.x == null", "did you mean None?"),
        ("len > 1", r"say len\(...\)"),
        ("__import__('os').system('ls')", "cannot call .*; a filter has m, constants, comparisons"),
        ("eval('1')", "cannot call 'eval'"),
        ("m.x.startswith('a')", "cannot call 'm.x.startswith'"),
        ("max(m.data, key=len)", "cannot call 'max'"),
        ("(lambda: 1)()", "cannot call 'lambda: 1'"),
        ("[x for x in m.data]", "cannot have"),
        ("{1: 2}", "cannot have"),
        ("m.data[0:3]", "cannot have '0:3'"),
        ("1 if m.x else 2", "cannot have"),
        ("f'{m}'", "cannot have"),
        ("b'a' in m", "cannot have"),
        ("1j", "cannot have '1j'"),
        ("...", "cannot have '...'"),
        ("(m := 1)", "cannot have"),
        ("max(*m.data)", "cannot have"),
    ],
)
def test_what_is_no_filter_is_refused_in_a_sentence(text: str, words: str) -> None:
    with pytest.raises(MessageError, match=words) as error:
        Filter(text)
    assert len(str(error.value)) < 300


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("m.twist.linaer.x > 1", "filter: Invalid field 'twist.linaer.x': .* did you mean twist.linear.x"),
        ("1 < 2 or abs(m.angular.z) > 1", "did you mean twist.angular.z?"),
        ("m['twits']", "did you mean twist?"),
        ("m.__class__.__mro__", "has no field '__class__'"),
        ("m.twist[-1]", "TwistStamped.twist is no list"),
    ],
)
def test_a_field_that_is_not_there_is_told_the_nearest(text: str, words: str) -> None:
    with pytest.raises(MessageError, match=words):
        Filter(text).check(STAMPED, "TwistStamped")


def test_which_fields_it_names() -> None:
    found = Filter("m.a.b[0] > max(m.c, m['d']) and m.a.b[0] < m.e[m.f] and m")
    assert set(found.fields) == {("a", "b", 0), ("c",), ("d",), ("e",), ("f",)}


@pytest.mark.parametrize("text", ["m.twist > 3", "1 / (m.header.stamp.sec - 1)", "m.twist.linear.x[0] == 1"])
def test_what_cannot_be_worked_out_of_a_message_is_an_error(text: str) -> None:
    with pytest.raises(MessageError, match="the filter does not suit a message: "):
        Filter(text).wants(STAMPED)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("m.twist > 3", "m.twist is made of fields"),
        ("m.header.frame_id < m.twist.linear.x", "m.header.frame_id is text, m.twist.linear.x is a number"),
        ("len(m.header.stamp.sec)", "m.header.stamp.sec is a number"),
        ("'a' < 1", "'<' not supported"),
    ],
)
def test_what_does_not_go_together_is_named(text: str, words: str) -> None:
    with pytest.raises(MessageError) as refusal:
        Filter(text).wants(STAMPED)
    assert words in str(refusal.value)


def test_yes_and_no_and_nothing_are_named_as_they_are() -> None:
    with pytest.raises(MessageError, match=r"m\.on is True, m\.off is None, m\.parts is a list$"):
        Filter("m.on < m.off or m.parts").wants({"on": True, "off": None, "parts": []})


@given(st.lists(WORDS, max_size=25).map(" ".join) | st.lists(WORDS, max_size=25).map("".join) | st.text())
@example("m.twist.linear.x" + " * m.twist.linear.x" * 50)
@example("[" * 60 + "]" * 60)
@example("not " * 200 + "m")
@example("9" * 999)
@example("'" + "\\d" * 400 + "'")
def test_any_text_is_a_filter_or_refused_soon(text: str) -> None:
    began = time.process_time()
    ask(text, STAMPED)
    assert time.process_time() - began < 1.0


def ask(text: str, values: Any) -> None:
    try:
        found = Filter(text)
        found.check(values, "A")
        assert isinstance(found.wants(values), bool)
    except MessageError:
        return


@pytest.mark.parametrize(
    "text", ["[lambda:" + "-" * 900 + "1]", "(a:=" + "-" * 900 + "1)", "(" + "-" * 900 + "m)(1)"]
)
def test_what_is_nested_too_deeply_is_refused_without_a_look_at_it(text: str) -> None:
    with pytest.raises(MessageError, match="nested at most 50 deep"):
        Filter(text)
