"""What there is to show, and lines that know their rank: in a small window the last ranks go first."""

from collections.abc import Sequence
from typing import Literal, NamedTuple

from zteleop.control.stick import Speeds
from zteleop.inputs.levers import Steps
from zteleop.screen.view import View
from zteleop.terminal.cells import Span

WIDE = 62
"""Columns from which on the lines are laid out as the Donkeycar nodes did."""
TABLE = 44
"""Columns that a table of two columns takes."""


class Dashboard(NamedTuple):
    """Everything shown."""

    robot: str
    drive: Literal["step", "hold"]
    speeds: Speeds
    seen: View = View()
    trail: Sequence[tuple[float, float]] = ()
    idle_left: float | None = None
    """s until neutral for want of a key; None when it is neutral already"""
    steps: Steps = Steps()


class Line(NamedTuple):
    """One line and its rank; 0 goes last."""

    rank: int
    spans: list[Span]


def line(rank: int, text: str = "", style: str = "") -> Line:
    """Return a line in one style."""
    return Line(rank, [Span(text, style)])
