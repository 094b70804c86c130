"""A scene as lines, seen from where its robot starts: small enough to be said, and to be drawn."""

from collections.abc import Sequence
from itertools import chain
from math import cos, sin
from typing import Annotated

import msgspec
from msgspec import Meta, Struct

from zteleop.errors import ConfigError
from zteleop.sim.scene import Box, Colour, Pose, Post, Scene, Tape, Wall

LONGEST = 200_000
"""characters of a plan"""
MOST_POINTS = 5_000
Coordinate = Annotated[float, Meta(ge=-10_000, le=10_000)]


class Trace(Struct, frozen=True, forbid_unknown_fields=True):
    """A line, in m of the odometry of a robot that begins at the scene's start: x ahead, y to the left."""

    points: Annotated[list[tuple[Coordinate, Coordinate]], Meta(min_length=2, max_length=MOST_POINTS)]
    colour: Colour


def plan(scene: Scene) -> list[Trace]:
    """Return all that stands or lies in a scene."""
    drawn: list[Wall | Tape] = [*scene.walls, *scene.tapes]
    standing: list[Post | Box] = [*scene.posts, *scene.boxes]
    lines = [(one.points, one.closed, one.colour) for one in drawn]
    lines += [(one.corners, True, one.colour) for one in standing]
    return [
        Trace([_seen_from(scene.start, at) for at in chain(points, points[:1] if closed else ())], colour)
        for points, closed, colour in lines
    ]


def _seen_from(start: Pose, point: tuple[float, float]) -> tuple[float, float]:
    """Return a point ahead of, and to the left of, a start."""
    x, y = point[0] - start.x, point[1] - start.y
    c, s = cos(start.heading), sin(start.heading)
    return x * c + y * s, y * c - x * s


def to_text(traces: Sequence[Trace]) -> str:
    """Return a plan as JSON, in whole cm; one that is too large to be drawn is left out."""
    short = [Trace([(round(x, 2), round(y, 2)) for x, y in one.points], one.colour) for one in traces]
    text = msgspec.json.encode(short).decode()
    return text if _fits(text, short) else "[]"


def from_text(text: str) -> list[Trace]:
    """Return the plan in a text; raises ConfigError for what is none, or too large to be drawn."""
    try:
        traces = msgspec.json.decode(text[: LONGEST + 1], type=list[Trace])
    except (msgspec.DecodeError, msgspec.ValidationError, RecursionError) as error:
        raise ConfigError(f"not a scene: {error}") from None
    if not _fits(text, traces):
        raise ConfigError(f"a scene of more than {MOST_POINTS} points is not shown")
    return traces


def _fits(text: str, traces: Sequence[Trace]) -> bool:
    return len(text) <= LONGEST and sum(len(one.points) for one in traces) <= MOST_POINTS
