"""Where acts come from: one file per device."""

from enum import Enum
from typing import Literal, Protocol, Self

from zteleop.control.stick import Speeds, Stick
from zteleop.messages import Vehicle

Drive = Literal["step", "hold"]
"""step makes Pwm (latched levers), hold makes Twist (drive while held)."""


class Wish(Enum):
    """What an operator may want besides driving."""

    STOP = "stop"
    """the robot, until that is released"""
    RELEASE = "release"
    """what stops it"""


class Input(Protocol):
    """A device an operator holds, used in a `with`."""

    drive: Drive
    rested: bool
    """It was at neutral since this was last taken, be it between two acts that came at once"""
    wish: Wish | None
    """What it asks of the robot besides; whoever takes it leaves None. A release never takes back a stop."""
    speeds: Speeds
    """What a full stick means; the robot bounds it"""

    @property
    def finished(self) -> bool:
        """The operator asked to end."""

    def fileno(self) -> int | None:
        """Return what turns readable when something was done; None for a device without a file."""

    def fit(self, vehicle: Vehicle) -> None:
        """Learn, or relearn, the limits of the robot driven."""

    def read(self, now: float) -> bool:
        """Take in what arrived, without blocking; True when the operator acted."""

    def stick(self, now: float) -> Stick:
        """Return where the stick is now."""

    def reset(self, now: float) -> None:
        """Go back to neutral; what is held must be let go first."""

    def __enter__(self) -> Self: ...
    def __exit__(self, *exc: object) -> None: ...
