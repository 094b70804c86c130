from zteleop.control.stick import Speeds, Stick
from zteleop.screen.dashboard import Dashboard, Line, line
from zteleop.terminal.cells import Span


def test_what_was_not_heard_is_not_there():
    board = Dashboard("archangel", "step", Speeds())
    assert board.stick == Stick()
    assert [board.vehicle, board.pwm, board.twist, board.status, board.odom, board.idle_left] == [None] * 6
    assert not board.ours


def test_a_line_has_a_rank_and_a_style():
    assert line(3, "text", "dim") == Line(3, [Span("text", "dim")])
