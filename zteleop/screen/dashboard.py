"""What there is to show, and lines that know their rank: in a small window the last ranks go first."""

from collections.abc import Sequence
from typing import Literal, NamedTuple

from zteleop.control.stick import Speeds, Stick
from zteleop.inputs.levers import Steps
from zteleop.messages import DriveStatus, Odometry, Pwm, Twist, Vehicle
from zteleop.terminal.cells import Span

WIDE = 62
"""Columns from which on the lines are laid out as the Donkeycar nodes did."""
TABLE = 44
"""Columns that a table of two columns takes."""


class Dashboard(NamedTuple):
    """Everything shown; what was not heard is None."""

    robot: str
    drive: Literal["step", "hold"]
    speeds: Speeds
    vehicle: Vehicle | None = None
    stick: Stick = Stick()
    pwm: Pwm | None = None
    """The ticks wanted now; None is neutral."""
    twist: Twist | None = None
    """The twist wanted now; None is rest."""
    status: DriveStatus | None = None
    ours: bool = False
    """We are the operator obeyed."""
    odom: Odometry | None = None
    trail: Sequence[tuple[float, float]] = ()
    idle_left: float | None = None
    """s until neutral for want of a key."""
    note: str = ""
    alarm: bool = False
    """The note says what the operator must know now."""
    steps: Steps = Steps()


class Line(NamedTuple):
    """One line and its rank; 0 goes last."""

    rank: int
    spans: list[Span]


def line(rank: int, text: str = "", style: str = "") -> Line:
    """Return a line in one style."""
    return Line(rank, [Span(text, style)])
