"""What there is to show, and lines that know their rank: in a small window the last ranks go first."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from zteleop.control.stick import Speeds
from zteleop.inputs import Drive
from zteleop.inputs.keymap import KEYMAPS, first_keys
from zteleop.inputs.levers import Steps
from zteleop.messages import Channel, DriveStatus, Pulse, Vehicle
from zteleop.screen.top_view import Mark
from zteleop.screen.view import View
from zteleop.terminal.cells import Span

WIDE = 62
"""Columns from which on the lines are laid out as the Donkeycar nodes did."""
USUAL = first_keys(KEYMAPS["all"])
LABEL = 10
"""Columns that the name of a line takes; fewer in a small window."""


class Task(NamedTuple):
    """What somebody is asked to do."""

    lines: Sequence[tuple[str, str]] = ()
    """each behind its name, or behind none"""
    unmeasured: bool = False
    """what a pulse means is being found out: nothing is known in m/s, nor where the wheels point"""
    ends: bool = False
    """the robot was this task's own, and is gone for good"""


class Dashboard(NamedTuple):
    """Everything shown."""

    robot: str
    drive: Drive
    speeds: Speeds
    seen: View = View()
    trail: Sequence[tuple[float, float]] = ()
    idle_left: float | None = None
    """s until neutral for want of a key; None when it is neutral already"""
    steps: Steps = Steps()
    others: str | None = ""
    """which robots could have been meant, where this one is not heard; None while it is too early to say"""
    task: Task = Task()
    about: Sequence[tuple[str, str]] = ()
    """what there is to say of the device, by a short name: how sure it is which keys are held"""
    in_vain: str = ""
    """what to do, while what the operator does counts for nothing"""
    floor: Sequence[Mark] = ()
    """lies around the robot"""
    bound: Mapping[str, str] = USUAL
    """for each action, its key"""
    keys: Sequence[tuple[str, str]] = ()
    """which, and what each does; shown instead of values and picture where there are any"""

    @property
    def status(self) -> DriveStatus | None:
        """What the robot does; None when nobody says so, or has not for too long."""
        return None if self.seen.silence else self.seen.status

    @property
    def looking(self) -> bool:
        """Whether it is too early to say that the robot is not heard."""
        return self.others is None

    @property
    def asks(self) -> bool:
        """Whether the operator asks for anything but rest."""
        return self.seen.command is not None

    @property
    def obeyed(self) -> bool:
        """Whether the robot does what this operator asks, as far as its limits allow."""
        return self.seen.ours and self.status is not None and self.status.state == "driving"

    @property
    def pulses(self) -> Sequence[Pulse]:
        """What leaves the chip: nothing while its outputs are cut, or nobody tells."""
        return () if self.status is None or self.status.confirmed == "cut" else self.status.pulses


class Line(NamedTuple):
    """One line and its rank; 0 goes last."""

    rank: int
    spans: list[Span]


def line(rank: int, text: str = "", style: str = "") -> Line:
    """Return a line in one style."""
    return Line(rank, [Span(text, style)])


def labelled(rank: int, name: str, text: str, columns: int, style: str = "") -> Line:
    """Return a line that begins with its name, which a small window cuts."""
    room = LABEL if columns >= 24 else 9 if columns >= 20 else 6
    return Line(rank, [Span(name[: room - 1].ljust(room)), Span(text, style)])


def channel(vehicle: Vehicle | None, name: str) -> Channel | None:
    """Return a vehicle's channel of this name."""
    return next((c for c in vehicle.channels if c.name == name), None) if vehicle else None
