"""The robot from above: where it is, where it was, and where its wheels point.

On the screen x is up and y is left (REP-103). The robot is drawn larger than life: its wheels are to be seen.
"""

from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import atan2, cos, hypot, isfinite, pi, sin

from zteleop.messages import Odometry, Vehicle

Dot = tuple[float, float]
SPAN = 4.0
"""m that the shorter side of the picture shows."""
JUMP = 0.5
"""m; points of the trail farther apart are not joined: the robot was put somewhere else."""
FARTHEST = 1e6
"""m; beyond this a pose is nonsense."""
BRAILLE = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
LENGTH, ALONE = 0.4, 0.75
"""Of the robot, on a map or by itself, as a part of the shorter side; all below are fractions of it."""
CAR = ((-0.5, 0.14), (0.25, 0.14), (0.5, 0.04))
TANK = ((-0.4, 0.2), (0.25, 0.2), (0.5, 0.02))
"""Half of the body, which is as wide on the other side: (ahead, aside) from tail to nose."""
AXLES = (-0.33, 0.3)
TRACK = 0.33
WHEEL = (0.16, 0.055)
"""Half the length and half the breadth."""
ROOM = (0.6, 0.48)
"""Half of what is kept clear around the robot."""


class Canvas:
    """Dots, two by four to a cell; without braille every line leaves the character nearest its slope."""

    def __init__(self, columns: int, rows: int, unicode: bool) -> None:
        self.columns = columns
        self.rows = rows
        self.unicode = unicode
        self._bits = [[0] * columns for _ in range(rows)]
        self._marks = [[" "] * columns for _ in range(rows)]

    def dot(self, x: float, y: float, mark: str = ".") -> None:
        """Set one dot, x to the right and y down; outside nothing happens."""
        column, row = int(x // 2), int(y // 4)
        if 0 <= column < self.columns and 0 <= row < self.rows:
            self._bits[row][column] |= BRAILLE[int(y) % 4][int(x) % 2]
            self._marks[row][column] = mark

    def line(self, start: Dot, end: Dot, mark: str = "") -> None:
        """Set the dots from one place to another."""
        (x, y), (right, down) = start, (end[0] - start[0], end[1] - start[1])
        steps = max(1, round(max(abs(right), abs(down))))
        for step in range(steps + 1):
            part = step / steps
            self.dot(x + part * right, y + part * down, mark or slope(right, down))

    def polygon(self, corners: Sequence[Dot], mark: str) -> None:
        """Set the dots inside a convex outline; the mark " " clears them."""
        heights = [y for _, y in corners]
        edges = [*pairwise(corners), (corners[-1], corners[0])]
        for row in range(round(min(heights)), round(max(heights))):
            y = row + 0.5
            across = [
                x0 + (x1 - x0) * (y - y0) / (y1 - y0)
                for (x0, y0), (x1, y1) in edges
                if (y0 <= y) != (y1 <= y)
            ]
            for x in range(round(min(across)), round(max(across))) if across else ():
                if mark == " ":
                    self._clear(x, row)
                else:
                    self.dot(x, row, mark)

    def _clear(self, x: int, y: int) -> None:
        column, row = x // 2, y // 4
        if 0 <= column < self.columns and 0 <= row < self.rows:
            self._bits[row][column] &= ~BRAILLE[y % 4][x % 2]
            self._marks[row][column] = " "

    def lines(self) -> list[str]:
        """Return the picture, every line of full width."""
        if not self.unicode:
            return ["".join(row) for row in self._marks]
        return ["".join(chr(0x2800 + bits) if bits else " " for bits in row) for row in self._bits]


def draw(
    odom: Odometry | None,
    trail: Sequence[tuple[float, float]],
    steering_angle: float,
    vehicle: Vehicle | None,
    columns: int,
    rows: int,
    unicode: bool,
) -> list[str]:
    """Return a picture of so many rows and columns; without odometry the robot alone, pointing up."""
    canvas = Canvas(columns, rows, unicode)
    across, down = 2 * columns, 4 * rows
    scale = min(across, down) / SPAN
    known = pose(odom)
    steering_angle = steering_angle if abs(steering_angle) < pi else 0.0
    x, y, heading = known or (0.0, 0.0, 0.0)
    middle_x, middle_y = window(x, down / scale), window(y, across / scale)

    def place(x: float, y: float) -> Dot:
        return across / 2 - (y - middle_y) * scale, down / 2 - (x - middle_x) * scale

    here = place(x, y)
    if known:
        draw_trail(canvas, [place(*point) for point in trail], JUMP * scale)
    draw_robot(
        canvas, here, heading, steering_angle, vehicle, min(across, down) * (LENGTH if known else ALONE)
    )
    picture = canvas.lines()
    return [*picture[:-1], scale_bar(scale, columns, unicode, picture[-1])] if known else picture


def pose(odom: Odometry | None) -> tuple[float, float, float] | None:
    """Return x, y in m and the heading in rad; None for no place on earth."""
    if odom is None:
        return None
    at, q = odom.pose.pose.position, odom.pose.pose.orientation
    heading = atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    near = abs(at.x) < FARTHEST and abs(at.y) < FARTHEST and isfinite(heading)
    return (at.x, at.y, heading) if near else None


def window(position: float, span: float) -> float:
    """Return the middle of the view: it jumps by half a picture, so that the robot is seen to move."""
    return round(position / (span / 2)) * (span / 2)


def draw_trail(canvas: Canvas, dots: Iterable[Dot], jump: float) -> None:
    for start, end in pairwise(dots):
        if hypot(end[0] - start[0], end[1] - start[1]) <= jump:
            canvas.line(start, end, ".")


def draw_robot(
    canvas: Canvas, here: Dot, heading: float, steering: float, vehicle: Vehicle | None, length: float
) -> None:
    """Draw the body, and four wheels of which the front ones steer, or two."""
    tank = vehicle is not None and not vehicle.steers
    middle = (round(here[0]), round(here[1]))

    def place(ahead: float, left: float) -> Dot:
        return (
            middle[0] - length * (ahead * sin(heading) + left * cos(heading)),
            middle[1] - length * (ahead * cos(heading) - left * sin(heading)),
        )

    def box(at: Dot, half: Dot, angle: float, mark: str) -> None:
        c, s = cos(angle), sin(angle)
        turned = [(u * c - v * s, u * s + v * c) for u, v in pairs(half)]
        canvas.polygon([place(at[0] + u, at[1] + v) for u, v in turned], mark)

    def wheel(axle: float, left: float, angle: float) -> None:
        half = (WHEEL[0], max(WHEEL[1], 0.8 / length))
        box((axle, left), half, angle, slope(-sin(heading + angle), -cos(heading + angle)))

    box((0.0, 0.0), ROOM, 0.0, " ")
    outline = TANK if tank else CAR
    for axle in () if tank else AXLES:
        canvas.line(place(axle, TRACK), place(axle, -TRACK))
    canvas.polygon([place(*p) for p in [*outline, *((u, -v) for u, v in reversed(outline))]], "#")
    canvas.polygon([place(*p) for p in [*outline[-2:], *((u, -v) for u, v in reversed(outline[-2:]))]], "o")
    for axle in (0.0,) if tank else AXLES:
        for left in (TRACK, -TRACK):
            wheel(axle, left, steering if axle > 0 else 0.0)


def pairs(half: Dot) -> tuple[Dot, Dot, Dot, Dot]:
    """Return the corners of a box, in order."""
    u, v = half
    return (u, v), (u, -v), (-u, -v), (-u, v)


def slope(right: float, down: float) -> str:
    """Return the character that looks most like a line, where a cell is twice as high as wide."""
    if abs(right) < abs(down) / 4:
        return "|"
    if abs(down) < abs(right) / 2:
        return "-"
    return "\\" if right * down > 0 else "/"


def scale_bar(scale: float, columns: int, unicode: bool, row: str) -> str:
    """Return the last row with the length of a metre on it."""
    cells = max(0, round(scale / 2) - 2)
    bar = f"├{'─' * cells}┤ 1 m " if unicode else f"|{'-' * cells}| 1 m "
    return bar + row[len(bar) :] if len(bar) <= columns else row
