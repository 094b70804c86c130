import pyte
from hypothesis import given
from hypothesis import strategies as st

from zteleop.terminal.frames import BEGIN, END, changes, one_line

LINES = st.lists(st.text("abc ", max_size=20).map(str.rstrip), max_size=8)


def test_only_what_changed_is_written():
    frame = changes(["one", "TWO"], ["one", "two", "three"])
    assert frame.startswith(BEGIN)
    assert frame.endswith(END)
    assert "TWO" in frame
    assert "one" not in frame
    assert changes(["one"], ["one"]) == ""


@given(st.lists(LINES, min_size=1, max_size=5))
def test_whatever_was_shown_the_screen_shows_the_lines(pages):
    screen = pyte.Screen(20, 8)
    stream = pyte.Stream(screen)
    stream.feed("rubbish")
    shown = None
    for page in pages:
        stream.feed(changes(page, shown))
        shown = page
        assert [line.rstrip() for line in screen.display] == page + [""] * (8 - len(page))


def test_one_line_covers_the_one_before():
    assert one_line(["driving", "more"], 10) == "\rdriving  "
    assert one_line([], 4) == "\r   "
    assert one_line(["driving"], 4) == "\rdri"
