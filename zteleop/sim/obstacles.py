"""Everything upright in a scene, in sides and posts, and which of them are near."""

from collections.abc import Iterable, Iterator
from math import hypot, inf
from typing import NamedTuple

from zteleop.sim import outline
from zteleop.sim.scene import Point, Scene

RUN = 8
"""sides in a row that are looked for as one"""


class Side(NamedTuple):
    """From `x`, `y` by `dx`, `dy`, and `radius` thick to every side; a post is a side without a length."""

    x: float
    y: float
    dx: float
    dy: float
    radius: float
    per_square: float
    """1 / length^2; 0 for a post"""
    name: str


class Run(NamedTuple):
    """Sides and the circle that holds them all."""

    x: float
    y: float
    radius: float
    sides: tuple[Side, ...]


class Obstacles:
    """All of a scene's sides, in runs."""

    def __init__(self, scene: Scene) -> None:
        self.runs = [_run(sides) for thing in _things(scene) for sides in _cut(thing)]
        self._boxes = [(f"boxes[{at}]", box.corners) for at, box in enumerate(scene.boxes)]

    def near(self, x: float, y: float, reach: float) -> list[Side]:
        """Return the sides within reach of a place, in m."""
        return [
            side
            for run in self.runs
            if hypot(run.x - x, run.y - y) <= reach + run.radius
            for side in run.sides
            if clearance(side, x, y) <= reach
        ]

    def filled(self, x: float, y: float) -> str | None:
        """Return the name of the box that a place lies within."""
        return next((name for name, corners in self._boxes if outline.encloses(corners, x, y)), None)


def clearance(side: Side, x: float, y: float) -> float:
    """Return how many m a place is from a side; negative within a post."""
    away_x, away_y = away(side, x, y)
    return hypot(away_x, away_y) - side.radius


def away(side: Side, x: float, y: float) -> Point:
    """Return the way to a place from the nearest on a side's middle line."""
    from_x, from_y = x - side.x, y - side.y
    along = (from_x * side.dx + from_y * side.dy) * side.per_square
    along = 0.0 if along < 0.0 else 1.0 if along > 1.0 else along
    return from_x - along * side.dx, from_y - along * side.dy


def _things(scene: Scene) -> Iterator[list[Side]]:
    for at, wall in enumerate(scene.walls):
        yield _sides(outline.sides(wall.points, wall.closed), f"walls[{at}]")
    for at, box in enumerate(scene.boxes):
        yield _sides(outline.sides(box.corners, closed=True), f"boxes[{at}]")
    for at, post in enumerate(scene.posts):
        yield [Side(*post.at, 0.0, 0.0, post.radius, 0.0, f"posts[{at}]")]


def _sides(ends: Iterable[tuple[Point, Point]], name: str) -> list[Side]:
    return [
        Side(ax, ay, bx - ax, by - ay, 0.0, 1 / ((bx - ax) ** 2 + (by - ay) ** 2), name)
        for (ax, ay), (bx, by) in ends
    ]


def _cut(sides: list[Side]) -> Iterator[tuple[Side, ...]]:
    for first in range(0, len(sides), RUN):
        yield tuple(sides[first : first + RUN])


def _run(sides: tuple[Side, ...]) -> Run:
    ends = [(side.x, side.y) for side in sides] + [(side.x + side.dx, side.y + side.dy) for side in sides]
    xs, ys = [x for x, _ in ends], [y for _, y in ends]
    x, y = (min(xs) + max(xs)) / 2, (min(ys) + max(ys)) / 2
    radius = max((hypot(ex - x, ey - y) for ex, ey in ends), default=inf)
    return Run(x, y, radius + max(side.radius for side in sides), sides)
