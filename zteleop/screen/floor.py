"""What a scene puts on the floor around a robot, as the picture shows it."""

from collections.abc import Sequence
from math import cos, sin

from zteleop.screen.top_view import Mark
from zteleop.sim.scene import Colour, Pose, Scene, Tape, Wall

STYLES: dict[Colour, str] = {"yellow": "yellow", "orange": "red", "red": "red", "green": "green"}
"""What a terminal has of the colours of a scene."""


def marks(scene: Scene) -> list[Mark]:
    """Return its lines, walls and posts, in m of the odometry of a robot that begins at its start."""
    lines: list[Wall | Tape] = [*scene.walls, *scene.tapes]
    found = [closed(line.points, line.closed, line.colour) for line in lines]
    found += [closed(post.corners, True, post.colour) for post in scene.posts]
    found += [closed(box.corners, True, box.colour) for box in scene.boxes]
    return [Mark([seen_from(scene.start, point) for point in mark.points], mark.style) for mark in found]


def closed(points: Sequence[tuple[float, float]], again: bool, colour: Colour) -> Mark:
    """Return a line, back to its first point where it goes there again."""
    return Mark([*points, *points[:1]] if again else points, STYLES.get(colour, ""))


def seen_from(start: Pose, point: tuple[float, float]) -> tuple[float, float]:
    """Return a point ahead of, and to the left of, a start."""
    x, y = point[0] - start.x, point[1] - start.y
    c, s = cos(start.heading), sin(start.heading)
    return x * c + y * s, y * c - x * s
