import pytest
from unit.screen.boards import text

from zteleop.screen.canvas import Canvas, slope


@pytest.mark.parametrize(
    ("right", "down", "mark"), [(1, 0, "-"), (0, 1, "|"), (1, 2, "\\"), (1, -2, "/"), (-1, 2, "/")]
)
def test_a_line_is_the_character_of_its_slope(right, down, mark):
    assert slope(right, down) == mark


def test_what_is_outside_is_not_drawn():
    canvas = Canvas(2, 1, True)
    canvas.line((-5, -5), (-1, -1))
    canvas.dot(4, 0)
    assert [text(spans) for spans in canvas.lines()] == ["  "]


def test_a_cell_has_the_style_of_what_was_drawn_last_and_an_empty_one_has_none():
    canvas = Canvas(4, 1, True)
    canvas.dot(0, 0, style="green")
    canvas.dot(2, 0, style="green")
    canvas.dot(2, 1, style="cyan")
    canvas.dot(4, 0, style="cyan")
    canvas.polygon([(4, 0), (6, 0), (6, 4), (4, 4)], " ")
    assert [(len(span.text), span.style) for span in canvas.lines()[0]] == [
        (1, "green"),
        (1, "cyan"),
        (2, ""),
    ]
