"""What a camera on a robot would see of its scene, as polygons of one colour each, farthest first.

A pinhole camera without distortion: u to the right and v down, in pixels.
"""

from collections.abc import Iterable, Iterator, Sequence
from math import cos, hypot, radians, sin, tan
from typing import NamedTuple

from zteleop.control.motion.pose import Pose2D
from zteleop.sim import outline
from zteleop.sim.scene import Box, Colour, Post, Scene

Space = tuple[float, float, float]
"""m ahead of the camera's foot, to its left, and above the floor."""
Rgb = tuple[int, int, int]
PAINTS: dict[Colour, Rgb] = {
    "black": (25, 25, 28),
    "white": (235, 235, 235),
    "grey": (120, 122, 125),
    "red": (190, 45, 40),
    "orange": (240, 120, 30),
    "yellow": (240, 200, 40),
    "green": (60, 150, 70),
    "blue": (55, 95, 180),
    "brown": (140, 95, 60),
}
SKY: Rgb = (190, 205, 215)
NOTHING: Rgb = (15, 15, 18)
"""where there is no floor"""
SHADE = 0.75
"""how bright the sides of a box are beside its top"""
NEAREST = 0.05
"""m, of what is seen; a corner behind it would be projected to infinity"""


class Lens(NamedTuple):
    """Where a camera is on its robot, and how wide it sees."""

    width: int = 320
    height: int = 240
    field_of_view: float = radians(75)
    """rad, from the left edge to the right"""
    above: float = 0.15
    """m over the floor"""
    ahead: float = 0.2
    """m of base_link"""
    tilt: float = radians(15)
    """rad that it looks down"""
    farthest: float = 8.0
    """m, of what is drawn"""

    @property
    def focal(self) -> float:
        """px"""
        return self.width / 2 / tan(self.field_of_view / 2)

    @property
    def horizon(self) -> float:
        """px from the top, where the floor ends"""
        return self.height / 2 - self.focal * tan(self.tilt)


class Polygon(NamedTuple):
    points: list[tuple[float, float]]
    """px"""
    colour: Rgb


class Surface(NamedTuple):
    """A flat piece of the scene: corners in its frame, m, the third above the floor."""

    corners: tuple[Space, ...]
    colour: Rgb
    x: float
    y: float
    reach: float
    """m around its middle"""


class Camera:
    """Sees a scene from wherever a robot is in it."""

    def __init__(self, scene: Scene, lens: Lens | None = None) -> None:
        self.lens = lens or Lens()
        self.floor: Rgb = PAINTS[scene.floor]
        self._flat = [_surface(corners, colour) for corners, colour in _flat(scene)]
        self._upright = [_surface(corners, colour) for corners, colour in _upright(scene)]

    def look(self, pose: Pose2D) -> list[Polygon]:
        """Return what is in the picture from a pose of base_link, in the frame of the scene."""
        eye = pose.ahead(self.lens.ahead)
        lying = [seen for _, surface in self._near(self._flat, eye) for seen in self._seen(surface, eye)]
        standing = sorted(self._near(self._upright, eye), key=lambda found: -found[0])
        return lying + [seen for _, surface in standing for seen in self._seen(surface, eye)]

    def _near(self, surfaces: Iterable[Surface], eye: Pose2D) -> Iterator[tuple[float, Surface]]:
        """Yield those that may be in the picture, each behind how far away it is."""
        c, s = cos(eye.heading), sin(eye.heading)
        for surface in surfaces:
            dx, dy = surface.x - eye.x, surface.y - eye.y
            if dx * c + dy * s < -surface.reach:  # behind
                continue
            if (far := hypot(dx, dy)) - surface.reach <= self.lens.farthest:
                yield far, surface

    def _seen(self, surface: Surface, eye: Pose2D) -> Iterator[Polygon]:
        """Yield what a surface is in the picture: nothing, or one polygon."""
        c, s, lens = cos(eye.heading), sin(eye.heading), self.lens
        down, up = cos(lens.tilt), sin(lens.tilt)
        found: list[Space] = []
        for x, y, z in surface.corners:
            dx, dy, dz = x - eye.x, y - eye.y, z - lens.above
            ahead = dx * c + dy * s
            found.append((ahead * down - dz * up, dx * s - dy * c, ahead * up + dz * down))
        clipped = _clipped(found)
        if len(clipped) < 3:
            return
        focal, middle_u, middle_v = lens.focal, lens.width / 2, lens.height / 2
        points = [
            (middle_u + focal * right / deep, middle_v - focal * over / deep) for deep, right, over in clipped
        ]
        us = [u for u, _ in points]
        if max(us) >= 0 and min(us) <= lens.width:
            yield Polygon(points, surface.colour)


def _clipped(corners: Sequence[Space]) -> list[Space]:
    """Return as much of a polygon as lies beyond `NEAREST`; depth comes first in each corner."""
    kept: list[Space] = []
    before = corners[-1]
    for corner in corners:
        if (before[0] < NEAREST) != (corner[0] < NEAREST):
            share = (NEAREST - before[0]) / (corner[0] - before[0])
            kept.append(
                (
                    NEAREST,
                    before[1] + share * (corner[1] - before[1]),
                    before[2] + share * (corner[2] - before[2]),
                )
            )
        if corner[0] >= NEAREST:
            kept.append(corner)
        before = corner
    return kept


def _surface(corners: Sequence[Space], colour: Rgb) -> Surface:
    x, y = (sum(corner[axis] for corner in corners) / len(corners) for axis in (0, 1))
    reach = max(hypot(corner[0] - x, corner[1] - y) for corner in corners)
    return Surface(tuple(corners), colour, x, y, reach)


def _flat(scene: Scene) -> Iterator[tuple[list[Space], Rgb]]:
    """Yield what lies on the floor, in the order of the scene."""
    for points in scene.drops:
        yield [(x, y, 0.0) for x, y in points], NOTHING
    for tape in scene.tapes:
        for (ax, ay), (bx, by) in outline.sides(tape.points, tape.closed):
            long = hypot(bx - ax, by - ay)
            ox, oy = (ay - by) / long * tape.width / 2, (bx - ax) / long * tape.width / 2
            corners = [(ax + ox, ay + oy), (bx + ox, by + oy), (bx - ox, by - oy), (ax - ox, ay - oy)]
            yield [(x, y, 0.0) for x, y in corners], PAINTS[tape.colour]


def _upright(scene: Scene) -> Iterator[tuple[list[Space], Rgb]]:
    """Yield what stands on the floor, side by side."""
    for wall in scene.walls:
        for a, b in outline.sides(wall.points, wall.closed):
            yield _standing(a, b, wall.height), PAINTS[wall.colour]
    things: list[Box | Post] = [*scene.boxes, *scene.posts]
    for thing in things:
        colour = PAINTS[thing.colour]
        side = (round(SHADE * colour[0]), round(SHADE * colour[1]), round(SHADE * colour[2]))
        for a, b in outline.sides(thing.corners, closed=True):
            yield _standing(a, b, thing.height), side
        yield [(x, y, thing.height) for x, y in thing.corners], colour


def _standing(a: tuple[float, float], b: tuple[float, float], height: float) -> list[Space]:
    return [(*a, 0.0), (*b, 0.0), (*b, height), (*a, height)]
