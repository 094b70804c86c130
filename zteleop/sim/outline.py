"""Lines on the floor plan: corners rounded by arcs, and what makes an outline impossible."""

from collections.abc import Iterator, Sequence
from itertools import pairwise
from math import atan2, ceil, cos, dist, pi, remainder, sin, tan, tau

Point = tuple[float, float]
ARC_STEP = pi / 24
"""rad of a chord; a circle of 0.5 m is true within 1 mm"""
SHORTEST = 1e-6
_ROUNDING = 1e-9


def check(points: Sequence[Point], closed: bool = False) -> None:
    """Raise ValueError when two points in turn are one, or a closed line encloses nothing."""
    for at, (here, after) in enumerate(pairwise(points)):
        if dist(here, after) < SHORTEST:
            raise ValueError(f"points[{at}] and points[{at + 1}] are one place, {here[0]:g}, {here[1]:g}")
    if not closed:
        return
    if dist(points[0], points[-1]) < SHORTEST:
        raise ValueError("the last point is the first again; closed = true goes back by itself")
    if len(points) < 3:
        raise ValueError(f"a closed line needs at least 3 points, found {len(points)}")


def area(points: Sequence[Point]) -> float:
    """Return what an outline encloses, in m^2."""
    return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in sides(points, closed=True))) / 2


def sides(points: Sequence[Point], closed: bool) -> Iterator[tuple[Point, Point]]:
    """Yield the two ends of each straight part."""
    yield from pairwise(points)
    if closed:
        yield points[-1], points[0]


def encloses(points: Sequence[Point], x: float, y: float) -> bool:
    """Say whether a place lies within an outline; where it crosses itself, within an odd number of times."""
    inside = False
    for (ax, ay), (bx, by) in sides(points, closed=True):
        if (ay > y) != (by > y) and x < ax + (y - ay) / (by - ay) * (bx - ax):
            inside = not inside
    return inside


def rounded(points: Sequence[Point], closed: bool, radius: float) -> list[Point]:
    """Return a line whose corners are arcs of a radius in m.

    Raises ValueError naming the corner that has no room for it.
    """
    corners = range(len(points)) if closed else range(1, len(points) - 1)
    tangents = {at: _tangent(points, at, radius) for at in corners}
    _check_room(points, closed, radius, tangents)
    line: list[Point] = []
    for at, point in enumerate(points):
        line += _arc(points, at, radius, tangents[at]) if at in tangents else [point]
    return _without_twins(line, closed)


def _check_room(points: Sequence[Point], closed: bool, radius: float, tangents: dict[int, float]) -> None:
    for at, (here, there) in enumerate(sides(points, closed)):
        after, length = (at + 1) % len(points), dist(here, there)
        needs = tangents.get(at, 0.0) + tangents.get(after, 0.0)
        if needs > length + _ROUNDING:
            raise ValueError(
                f"a bend of {radius:g} m needs {needs:.3g} m from points[{at}] to points[{after}], "
                f"which are {length:.3g} m apart"
            )


def _bearings(points: Sequence[Point], at: int) -> tuple[float, float]:
    """Return which way a line comes to a corner, and by how much it turns there, in rad."""
    (ax, ay), (bx, by), (cx, cy) = points[at - 1], points[at], points[(at + 1) % len(points)]
    bearing = atan2(by - ay, bx - ax)
    return bearing, remainder(atan2(cy - by, cx - bx) - bearing, tau)


def _tangent(points: Sequence[Point], at: int, radius: float) -> float:
    """Return how many m before a corner its arc begins."""
    turn = abs(_bearings(points, at)[1])
    if turn > pi - 0.01:
        raise ValueError(f"points[{at}] turns straight back, which no bend can")
    return radius * tan(turn / 2)


def _arc(points: Sequence[Point], at: int, radius: float, tangent: float) -> list[Point]:
    bearing, turn = _bearings(points, at)
    if abs(turn) < _ROUNDING:
        return [points[at]]
    x, y = points[at][0] - tangent * cos(bearing), points[at][1] - tangent * sin(bearing)
    side = radius if turn > 0 else -radius
    middle_x, middle_y = x - side * sin(bearing), y + side * cos(bearing)
    chords = max(1, ceil(abs(turn) / ARC_STEP - _ROUNDING))
    angles = [bearing + turn * step / chords for step in range(chords + 1)]
    return [(middle_x + side * sin(angle), middle_y - side * cos(angle)) for angle in angles]


def _without_twins(line: list[Point], closed: bool) -> list[Point]:
    kept = [line[0]] + [point for before, point in pairwise(line) if dist(before, point) >= SHORTEST]
    return kept[:-1] if closed and dist(kept[0], kept[-1]) < SHORTEST else kept
