"""What lies on the floor around a robot, as the picture shows it."""

from collections.abc import Sequence

from zteleop.screen.top_view import Mark
from zteleop.sim.plan import Trace
from zteleop.sim.scene import Colour

STYLES: dict[Colour, str] = {"yellow": "yellow", "orange": "red", "red": "red", "green": "green"}
"""What a terminal has of the colours of a scene."""


def marks(plan: Sequence[Trace]) -> list[Mark]:
    """Return the lines of a plan in a terminal's colours."""
    return [Mark(trace.points, STYLES.get(trace.colour, "")) for trace in plan]
