from zteleop.screen.dashboard import Line, line
from zteleop.terminal.cells import Span


def test_a_line_has_a_rank_and_a_style():
    assert line(3, "text", "dim") == Line(3, [Span("text", "dim")])
