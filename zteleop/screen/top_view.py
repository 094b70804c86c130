"""The robot from above: where it is, where it was, what lies on its floor, and where its wheels point.

On the screen x is up and y is left (REP-103). A robot too small to see is drawn larger, and the scale says
so.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import atan2, ceil, hypot, isfinite, pi
from typing import NamedTuple

from zteleop.messages import Odometry, Vehicle
from zteleop.screen.canvas import Canvas, Dot
from zteleop.screen.chassis import draw_chassis, length_of
from zteleop.terminal.cells import Span, cut_left

SPANS = (3.0, 4.0, 6.0, 8.0, 12.0, 16.0, 24.0, 32.0, 48.0)
"""m that the shorter side of the picture shows: the least that holds the whole trail."""
MARGIN = 0.4
"""m around the trail"""
SNAP = 4
"""Parts of a picture's side by which it jumps, so that the robot is seen to move."""
VISIBLE = 20.0
"""Dots below which a robot's wheels are not seen."""
JUMP = 0.5
"""m; points of the trail farther apart are not joined: the robot was put somewhere else."""
FARTHEST = 1e6
"""m; beyond this a pose is nonsense."""


class Mark(NamedTuple):
    """A line on the floor, in m of the robot's odometry."""

    points: Sequence[Dot]
    style: str = ""


class Window(NamedTuple):
    """What part of the floor is seen, and how large."""

    middle: Dot
    dots_per_m: float
    across: int
    down: int

    def place(self, at: Dot) -> Dot:
        """Return the dot of a place in m."""
        (x, y), (middle_x, middle_y), scale = at, self.middle, self.dots_per_m
        return self.across / 2 - (y - middle_y) * scale, self.down / 2 - (x - middle_x) * scale


def draw(
    odom: Odometry | None,
    trail: Sequence[Dot],
    steering_angle: float,
    vehicle: Vehicle | None,
    columns: int,
    rows: int,
    unicode: bool,
    floor: Sequence[Mark] = (),
) -> list[list[Span]]:
    """Return a picture of so many rows and columns; without odometry the robot alone, pointing up."""
    canvas = Canvas(columns, rows, unicode)
    known = pose(odom)
    x, y, heading = known or (0.0, 0.0, 0.0)
    seen = [point for point in trail if hypot(*point) < FARTHEST] if known else []
    window = choose_window([(x, y), *seen], 2 * columns, 4 * rows)
    if known:
        for mark in floor:
            draw_path(canvas, [window.place(point) for point in mark.points], float("inf"), mark.style)
        draw_path(canvas, [window.place(point) for point in seen], JUMP * window.dots_per_m, "green")
    true_length = length_of(vehicle) * window.dots_per_m
    larger = max(1, ceil(VISIBLE / true_length))
    steering_angle = steering_angle if abs(steering_angle) < pi else 0.0
    draw_chassis(canvas, window.place((x, y)), heading, steering_angle, vehicle, larger * true_length)
    picture = canvas.lines()
    if not known:
        return picture
    return [*picture[:-1], scale_bar(window.dots_per_m, larger, columns, unicode, picture[-1])]


def pose(odom: Odometry | None) -> tuple[float, float, float] | None:
    """Return x, y in m and the heading in rad; None for no place on earth."""
    if odom is None:
        return None
    at, q = odom.pose.pose.position, odom.pose.pose.orientation
    heading = atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    near = abs(at.x) < FARTHEST and abs(at.y) < FARTHEST and isfinite(heading)
    return (at.x, at.y, heading) if near else None


def choose_window(points: Sequence[Dot], across: int, down: int) -> Window:
    """Return the closest look at all these places; where none holds them, one at the first."""
    shorter, xy = min(across, down), tuple(zip(*points, strict=True))
    for span in SPANS:
        scale = shorter / span
        ahead, aside = (hold(values, dots / scale) for values, dots in zip(xy, (down, across), strict=True))
        if ahead is not None and aside is not None:
            return Window((ahead, aside), scale, across, down)
    scale = shorter / SPANS[0]
    x, y = points[0]
    return Window((snap(x, down / scale), snap(y, across / scale)), scale, across, down)


def hold(values: Sequence[float], side: float) -> float | None:
    """Return the middle of a side of a view that holds all of one coordinate; None when none does."""
    least, most = min(values), max(values)
    middle = snap((least + most) / 2, side)
    return middle if max(most - middle, middle - least) + MARGIN <= side / 2 else None


def snap(position: float, side: float) -> float:
    """Return the middle of a view: it jumps by a part of its side."""
    return round(position / (side / SNAP)) * (side / SNAP)


def draw_path(canvas: Canvas, dots: Iterable[Dot], jump: float, style: str) -> None:
    for start, end in pairwise(dots):
        if hypot(end[0] - start[0], end[1] - start[1]) <= jump:
            canvas.line(start, end, ".", style)


def scale_bar(scale: float, larger: int, columns: int, unicode: bool, row: list[Span]) -> list[Span]:
    """Return the last row with the length of a metre on it, and how much too large the robot is drawn."""
    cells = max(0, round(scale / 2) - 2)
    bar = f"├{'─' * cells}┤ 1 m " if unicode else f"|{'-' * cells}| 1 m "
    bar += f" robot {larger}x " if larger > 1 else ""
    if len(bar) > columns:
        return row
    return [Span(bar, "dim"), *cut_left(row, len(bar))]
