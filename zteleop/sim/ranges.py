"""How far it is to the nearest wall or obstacle along a ray, and what a range sensor makes of it."""

from collections.abc import Iterable
from math import cos, hypot, inf, pi, radians, sin, sqrt
from random import Random
from typing import Annotated

from msgspec import Meta, Struct

from zteleop.messages import Header, Range
from zteleop.sim.obstacles import Run, Side
from zteleop.sim.surroundings import Surroundings

Metres = Annotated[float, Meta(gt=0, le=1000)]
RAYS = 5
_PARALLEL = 1e-12


class RangeSensor(Struct, frozen=True, forbid_unknown_fields=True):
    """Ultrasound that looks ahead, such as an HC-SR04: the nearest in its cone."""

    field_of_view: Annotated[float, Meta(gt=0, le=2 * pi)] = radians(15)
    """rad from edge to edge"""
    min_range: Metres = 0.02
    max_range: Metres = 4.0

    def measure(self, around: Surroundings, ahead: float) -> float:
        """Return the m to the nearest thing, seen from `ahead` of base_link."""
        first, step = -self.field_of_view / 2, self.field_of_view / (RAYS - 1)
        return min(around.distance(ahead, 0.0, first + step * ray, self.max_range) for ray in range(RAYS))

    def state(self, header: Header, distance: float, chance: Random, spread: float = 0.0) -> Range:
        """Return what it tells of a distance: that, a chance error, and what it can tell at all."""
        seen = distance + chance.gauss(0, spread) if spread and distance < self.max_range else distance
        seen = max(self.min_range, min(self.max_range, seen))
        return Range(header, 0, self.field_of_view, self.min_range, self.max_range, seen, spread**2)


def distance(runs: Iterable[Run], x: float, y: float, bearing: float, longest: float) -> float:
    """Return the m from a place to the nearest side along a bearing; at most `longest`."""
    ux, uy = cos(bearing), sin(bearing)
    nearest = longest
    for run in runs:
        to_x, to_y = run.x - x, run.y - y
        along = to_x * ux + to_y * uy
        if along - run.radius < nearest and along > -run.radius and abs(to_x * uy - to_y * ux) <= run.radius:
            for side in run.sides:
                nearest = min(nearest, hit(side, x, y, ux, uy))
    return nearest


def hit(side: Side, x: float, y: float, ux: float, uy: float) -> float:
    """Return how many m along a unit vector a side is; inf where the ray misses it."""
    to_x, to_y = side.x - x, side.y - y
    if side.radius:
        return _hit_post(to_x, to_y, side.radius, ux, uy)
    across = ux * side.dy - uy * side.dx
    if abs(across) < _PARALLEL:
        return _hit_end(side, to_x, to_y, ux, uy)
    far = (to_x * side.dy - to_y * side.dx) / across
    share = (to_x * uy - to_y * ux) / across
    return far if far >= 0.0 and 0.0 <= share <= 1.0 else inf


def _hit_post(to_x: float, to_y: float, radius: float, ux: float, uy: float) -> float:
    along, aside = to_x * ux + to_y * uy, to_x * uy - to_y * ux
    if abs(aside) > radius:
        return inf
    half = sqrt(radius * radius - aside * aside)
    if along + half < 0.0:
        return inf
    return max(0.0, along - half)


def _hit_end(side: Side, to_x: float, to_y: float, ux: float, uy: float) -> float:
    """Return how far the nearer end is of a side that lies along the ray."""
    if abs(to_x * uy - to_y * ux) > _PARALLEL * (1 + hypot(to_x, to_y)):
        return inf
    ends = to_x * ux + to_y * uy, (to_x + side.dx) * ux + (to_y + side.dy) * uy
    if max(ends) < 0.0:
        return inf
    return max(0.0, min(ends))
