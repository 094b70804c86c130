"""Dashboards from what is seen of a robot."""

from typing import Any, Literal

from zteleop.control.stick import Speeds
from zteleop.messages import Vehicle
from zteleop.screen.dashboard import Dashboard
from zteleop.screen.view import View


def dashboard(
    drive: Literal["step", "hold"] = "step",
    vehicle: Vehicle | None = None,
    *,
    robot: str = "car",
    speeds: Speeds | None = None,
    idle_left: float | None = None,
    **seen: Any,
) -> Dashboard:
    """Return what is shown of a vehicle of which so much is seen."""
    view = View(vehicle=vehicle, **seen)
    return Dashboard(robot, drive, speeds or Speeds(), view, idle_left=idle_left)
