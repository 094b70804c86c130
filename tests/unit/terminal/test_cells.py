import pytest
from hypothesis import given
from hypothesis import strategies as st

from zteleop.terminal.cells import Span, cut, cut_left, fit, pad, paint, printable, width, wrap


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("obeying keyboard", "obeying keyboard"),
        ("a\x1b[2Jb", "a\\x1b[2Jb"),
        ("a\r\n\tb\x07", "a\\r\\n\\tb\\x07"),
        ("\x9b2J", "\\x9b2J"),
        ("abc\u202edef", "abc\\u202edef"),
        ("Zürich 文", "Zürich 文"),
    ],
)
def test_text_from_outside_cannot_move_the_cursor(text, shown):
    assert printable(text) == shown


def test_without_unicode_everything_is_ascii():
    assert printable("Zürich 文", unicode=False) == "Z\\xfcrich \\u6587"


@pytest.mark.parametrize(("text", "cells"), [("abc", 3), ("文字", 4), ("e\u0301", 1), ("", 0)])
def test_width_is_in_cells(text, cells):
    assert width(text) == cells


def test_words_stay_whole_where_they_fit():
    assert wrap("nobody moves: no actuator heard", 14) == ["nobody moves:", "no actuator", "heard"]
    assert wrap("abcdefgh ij", 3) == ["abc", "def", "gh", "ij"]
    assert wrap("", 5) == []


@given(st.text(max_size=50), st.integers(0, 20))
def test_nothing_is_wider_than_asked(text, cells):
    shown = printable(text)
    assert shown.isprintable()
    assert width(cut(shown, cells)) <= cells
    assert all(width(line) <= cells for line in wrap(shown, cells))
    assert sum(width(span.text) for span in pad([Span(shown), Span(shown)], cells)) == cells


def test_a_line_is_cut_across_spans_and_styled():
    spans = fit([Span("abc", "bold"), Span("def", "red"), Span("ghi")], 5)
    assert spans == [Span("abc", "bold"), Span("de", "red")]
    assert paint(spans, color=False) == "abcde"
    assert paint(spans, color=True) == "\x1b[1mabc\x1b[0m\x1b[31mde\x1b[0m"


def test_a_line_without_its_first_cells_keeps_its_styles():
    line = [Span("ab", "red"), Span("cd"), Span("ef", "dim")]
    for cells, kept in ((0, line), (1, [Span("b", "red"), *line[1:]]), (3, [Span("d"), line[2]]), (9, [])):
        assert cut_left(line, cells) == kept
