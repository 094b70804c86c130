"""Dashboards from what is seen of a robot."""

from collections.abc import Iterable, Mapping
from typing import Any, Literal

from zteleop.control.stick import Speeds
from zteleop.messages import DriveStatus, Pulse, Twist, Vehicle
from zteleop.screen.dashboard import Dashboard, Line
from zteleop.screen.view import View
from zteleop.terminal.cells import Span


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


def status(**changes: Any) -> DriveStatus:
    """Return the status of a robot that a keyboard drives."""
    fields: dict[str, Any] = {
        **{"state": "driving", "why": "keyboard b1c0 drives", "source": "keyboard", "operator": "3fa2b1c0"},
        **{"wanted": Twist.planar(0.3, 0.5), "applied": Twist.planar(0.25, 0.4)},
        **{"pulses": [], "seq": 1, "written": 0.0, "stops": [], "unkept": "", "confirmed": ""},
        **{"refused": 0, "clamped": 0},
        **{"max_speed": 3.0, "latency": 0.06, "slowed": "", "released": 0},
    }
    return DriveStatus(**fields | changes)


def pulses(vehicle: Vehicle, ticks: Mapping[str, int]) -> list[Pulse]:
    """Return what the chip of a vehicle puts out, in ticks; all else is neutral."""
    found = []
    for channel in vehicle.channels:
        moved = ticks.get(channel.name, channel.neutral_ticks) - channel.neutral_ticks
        end = (channel.max_ticks if moved > 0 else channel.min_ticks) - channel.neutral_ticks
        duty = channel.neutral_ticks + moved
        fraction = abs(moved / end) * (1 if moved > 0 else -1) if moved else 0.0
        found.append(Pulse(channel.name, channel.channel, fraction, duty * 4.08, duty))
    return found


def text(spans: Iterable[Span]) -> str:
    return "".join(span.text for span in spans)


def texts(lines: Iterable[Line]) -> list[str]:
    return [text(line.spans) for line in lines]
