"""The robot from above: where it is, where it was, and where its wheels point.

On the screen x is up and y is left (REP-103). The robot is drawn larger than life, so that its wheels are seen.
"""

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from math import atan2, cos, hypot, isfinite, sin

from zteleop.messages import Odometry, Vehicle

Dot = tuple[float, float]
SPAN = 4.0
"""m that the shorter side of the picture shows."""
JUMP = 0.5
"""m; points of the trail farther apart are not joined: the robot was put somewhere else."""
FARTHEST = 1e6
"""m; beyond this a pose is nonsense."""
BRAILLE = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
LENGTH = 0.4
"""Of the robot, as a part of the shorter side; its other measures are fractions of its length."""
CAR = ((-0.5, 0.14), (0.25, 0.14), (0.5, 0.04))
TANK = ((-0.4, 0.22), (0.25, 0.22), (0.5, 0.0))
"""Half of the body, which is as wide on the other side: (ahead, aside) from tail to nose."""
NOSE = 0.25
AXLES = (-0.33, 0.3)
TRACK, TANK_TRACK = 0.32, 0.36
WHEEL = (0.16, 0.055)
"""Half the length and half the breadth."""
ROOM = (0.6, 0.48)
"""Half of what is kept clear around the robot."""


class Canvas:
    """Dots, two by four to a cell; without braille every line leaves the character nearest its slope."""

    def __init__(self, columns: int, rows: int, unicode: bool) -> None:
        self.columns, self.rows, self.unicode = columns, rows, unicode
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

    def fill(self, middle: Dot, radius: float, mark: Callable[[float, float], str | None]) -> None:
        """Set the dots whose offset from the middle has a mark; " " clears them, None leaves them."""
        for y in range(int(middle[1] - radius), int(middle[1] + radius) + 2):
            for x in range(int(middle[0] - radius), int(middle[0] + radius) + 2):
                found = mark(x + 0.5 - middle[0], y + 0.5 - middle[1])
                if found == " ":
                    self._clear(x, y)
                elif found:
                    self.dot(x, y, found)

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
    x, y, heading = pose(odom) or (0.0, 0.0, 0.0)
    middle_x, middle_y = window(x, down / scale), window(y, across / scale)

    def place(x: float, y: float) -> Dot:
        return across / 2 - (y - middle_y) * scale, down / 2 - (x - middle_x) * scale

    here = place(x, y)
    if pose(odom):
        draw_trail(canvas, [place(*point) for point in trail], JUMP * scale)
    draw_robot(canvas, here, heading, steering_angle, vehicle, min(across, down) * LENGTH)
    picture = canvas.lines()
    return [*picture[:-1], scale_bar(scale, columns, unicode, picture[-1])] if pose(odom) else picture


def pose(odom: Odometry | None) -> tuple[float, float, float] | None:
    """Return x, y in m and the heading in rad; None for no place on earth."""
    if odom is None:
        return None
    at, q = odom.pose.pose.position, odom.pose.pose.orientation
    heading = atan2(2 * (q.w * q.z + q.x * q.y), 1 - 2 * (q.y * q.y + q.z * q.z))
    near = abs(at.x) < FARTHEST and abs(at.y) < FARTHEST and isfinite(heading)
    return (at.x, at.y, heading) if near else None


def window(position: float, span: float) -> float:
    """Return the middle of the view: it moves on by half a picture at a time, so that the robot is seen to move."""
    return round(position / (span / 2)) * (span / 2)


def draw_trail(canvas: Canvas, dots: Iterable[Dot], jump: float) -> None:
    for start, end in pairwise(dots):
        if hypot(end[0] - start[0], end[1] - start[1]) <= jump:
            canvas.line(start, end, ".")


def draw_robot(
    canvas: Canvas, here: Dot, heading: float, steering: float, vehicle: Vehicle | None, length: float
) -> None:
    """Draw the body, and four wheels of which the front ones steer, or two."""
    tank = vehicle is not None and vehicle.kind == "differential"
    middle = (round(here[0]), round(here[1]))
    ahead, left = (-sin(heading), -cos(heading)), (-cos(heading), sin(heading))

    def mark(right: float, down: float) -> str | None:
        u = (right * ahead[0] + down * ahead[1]) / length
        v = (right * left[0] + down * left[1]) / length
        return part(u, v, steering, tank, length)

    def rolls(angle: float) -> str:
        return slope(-sin(heading + angle), -cos(heading + angle))

    marks = {"front": rolls(steering), "rear": rolls(0.0), "body": "#", "nose": "o", "axle": "-", "room": " "}
    for kinds in (("room",), ("axle",), ("body", "nose"), ("rear",), ("front",)):
        canvas.fill(middle, length, lambda x, y: marks[found] if (found := mark(x, y)) in kinds else None)


def part(u: float, v: float, steering: float, tank: bool, dots: float) -> str | None:
    """Return which part of the robot is at u ahead and v to the left of its middle."""
    for axle in (0.0,) if tank else AXLES:
        track = TANK_TRACK if tank else TRACK
        angle = steering if axle > 0 else 0.0
        ahead, aside = u - axle, abs(v) - track if v > 0 else -(abs(v) - track)
        along = ahead * cos(angle) + aside * sin(angle)
        across = aside * cos(angle) - ahead * sin(angle)
        if abs(along) <= WHEEL[0] and abs(across) <= max(WHEEL[1], 0.8 / dots):
            return "front" if axle > 0 else "rear"
    if abs(v) <= breadth(u, TANK if tank else CAR):
        return "nose" if u > NOSE else "body"
    if not tank and abs(v) < TRACK and any(abs(u - axle) <= 0.5 / dots for axle in AXLES):
        return "axle"
    return "room" if abs(u) < ROOM[0] and abs(v) < ROOM[1] else None


def breadth(u: float, outline: Sequence[Dot]) -> float:
    """Return half the breadth of a body at u ahead of its middle; below 0 there is no body."""
    for (tail, wide), (nose, narrow) in pairwise(outline):
        if tail <= u <= nose:
            return wide + (narrow - wide) * (u - tail) / (nose - tail)
    return -1.0


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
