import pytest
from unit.screen.boards import text

from zteleop.screen.canvas import Canvas, Dot, clip, slope


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


@pytest.mark.parametrize(
    ("start", "end", "seen"),
    [
        ((1, 2), (3, 4), ((1, 2), (3, 4))),
        ((-5, 5), (15, 5), ((0, 5), (10, 5))),
        ((5, -1e9), (5, 1e9), ((5, 0), (5, 20))),
        ((-10, -10), (30, 30), ((0, 0), (10, 10))),
        ((-1, 5), (-1, 9), None),
        ((-10, 5), (5, -10), None),
        ((11, 21), (12, 22), None),
    ],
)
def test_a_line_is_cut_at_the_edges_of_the_picture(
    start: Dot, end: Dot, seen: tuple[Dot, Dot] | None
) -> None:
    found = clip(start, end, 10, 20)
    if seen is None:
        assert found is None
    else:
        assert found is not None
        assert [*found[0], *found[1]] == pytest.approx([*seen[0], *seen[1]], abs=1e-5)


def test_a_line_of_a_thousand_kilometres_costs_no_more_than_what_is_seen_of_it(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    canvas, dots = Canvas(4, 4, True), []
    monkeypatch.setattr(canvas, "dot", lambda *at: dots.append(at))
    canvas.line((-1e9, 3.0), (1e9, 3.0))
    assert len(dots) <= 12
