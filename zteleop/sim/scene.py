"""What a robot drives in: walls, tape on the floor, obstacles, drops, a dock, and where it starts.

Metres in the frame of the scene, x to the right of the plan and y up; angles in degrees, as people write
them.
"""

from math import cos, radians, sin, tau
from typing import Annotated, Literal, get_args

import msgspec
from msgspec import Meta, Struct
from msgspec.structs import force_setattr

from zteleop.errors import ConfigError, nearest
from zteleop.sim import outline

Coordinate = Annotated[float, Meta(ge=-1000, le=1000)]
Length = Annotated[float, Meta(gt=0, le=1000)]
Point = tuple[Coordinate, Coordinate]
Points = Annotated[list[Point], Meta(min_length=2, max_length=1000)]
Degrees = Annotated[float, Meta(ge=-360, le=360)]
Colour = Literal["black", "white", "grey", "red", "orange", "yellow", "green", "blue", "brown"]
LONGEST = 2**20
"""bytes of a file"""
MOST_SIDES = 10_000
"""of everything together; a bend has up to 48 in a whole turn"""
POST_SIDES = 12
"""by which a round post is shown"""


CALLED = {"walls": "wall", "posts": "post", "boxes": "box"}


class Pose(Struct, frozen=True, forbid_unknown_fields=True):
    x: Coordinate = 0.0
    y: Coordinate = 0.0
    heading_deg: Degrees = 0.0
    """0 along x, 90 along y"""

    @property
    def heading(self) -> float:
        """rad"""
        return radians(self.heading_deg)


class Line(Struct, frozen=True, forbid_unknown_fields=True):
    """Along the points in turn; a bend is laid out as soon as it is read, and leaves more points."""

    points: Points
    closed: bool = False
    """back to the first point"""
    bend: Annotated[float, Meta(ge=0, le=1000)] = 0.0
    """m, the radius by which corners are rounded"""

    def __post_init__(self) -> None:
        outline.check(self.points, self.closed)
        if self.bend:
            force_setattr(self, "points", outline.rounded(self.points, self.closed, self.bend))
            force_setattr(self, "bend", 0.0)


class Wall(Line, frozen=True, forbid_unknown_fields=True):
    """Upright, and too thin to measure."""

    height: Length = 0.4
    colour: Colour = "brown"


class Tape(Line, frozen=True, forbid_unknown_fields=True):
    """A line on the floor."""

    width: Length = 0.05
    colour: Colour = "white"


class Post(Struct, frozen=True, forbid_unknown_fields=True):
    """A round obstacle, such as a cone or the leg of a chair."""

    at: Point
    radius: Length = 0.1
    height: Length = 0.3
    colour: Colour = "orange"

    @property
    def corners(self) -> list[tuple[float, float]]:
        """Its outline, anticlockwise, as straight sides."""
        (x, y), angles = self.at, [tau * i / POST_SIDES for i in range(POST_SIDES)]
        return [(x + self.radius * cos(angle), y + self.radius * sin(angle)) for angle in angles]


class Box(Struct, frozen=True, forbid_unknown_fields=True):
    """A box that stands on the floor."""

    at: Point
    """its middle"""
    size: tuple[Length, Length] = (0.3, 0.3)
    heading_deg: Degrees = 0.0
    height: Length = 0.3
    colour: Colour = "blue"

    @property
    def corners(self) -> list[tuple[float, float]]:
        """Its outline, anticlockwise."""
        (x, y), (length, width) = self.at, (side / 2 for side in self.size)
        c, s = cos(radians(self.heading_deg)), sin(radians(self.heading_deg))
        ends = ((length, width), (-length, width), (-length, -width), (length, -width))
        return [(x + a * c - b * s, y + a * s + b * c) for a, b in ends]


class Scene(Struct, frozen=True, forbid_unknown_fields=True):
    """A scene as it stands in a TOML file; an empty one is a floor without end."""

    floor: Colour = "grey"
    start: Pose = Pose()
    dock: Pose | None = None
    """where a Create 3 charges, and which way it looks when it stands there"""
    walls: Annotated[list[Wall], Meta(max_length=1000)] = []
    tapes: Annotated[list[Tape], Meta(max_length=1000)] = []
    posts: Annotated[list[Post], Meta(max_length=1000)] = []
    boxes: Annotated[list[Box], Meta(max_length=1000)] = []
    drops: Annotated[
        list[Annotated[list[Point], Meta(min_length=3, max_length=1000)]], Meta(max_length=1000)
    ] = []
    """outlines of where the floor ends, such as a flight of stairs"""

    def __post_init__(self) -> None:
        for at, points in enumerate(self.drops):
            _check_drop(at, points)
            if outline.encloses(points, self.start.x, self.start.y):
                raise ValueError(f"the start lies in drops[{at}], where there is no floor")
        if (found := self._sides()) > MOST_SIDES:
            raise ValueError(f"a scene has at most {MOST_SIDES} straight sides in all, found {found}")

    def called(self, name: str) -> str:
        """Return a part of it in words, by a name such as posts[0]."""
        kind, at = name.rstrip("]").split("[")
        if kind == "drops":
            return "the edge of the floor"
        return f"the {getattr(self, kind)[int(at)].colour} {CALLED[kind]}"

    def _sides(self) -> int:
        lines = [len(line.points) for line in (*self.walls, *self.tapes)]
        return sum(lines) + 4 * len(self.boxes) + sum(len(points) for points in self.drops)


def parse(text: bytes) -> Scene:
    """Return the scene a TOML text makes; raises ConfigError with the path and the reason of a mistake."""
    if len(text) > LONGEST:
        raise ConfigError(f"expected at most {LONGEST} bytes of a scene, found more")
    try:
        return msgspec.convert(msgspec.toml.decode(text), Scene)
    except msgspec.ValidationError as error:
        raise ConfigError(_in_words(str(error))) from None
    except (msgspec.DecodeError, ValueError, RecursionError) as error:
        raise ConfigError(f"not TOML: {error}") from None


def _check_drop(at: int, points: list[Point]) -> None:
    try:
        outline.check(points, closed=True)
    except ValueError as error:
        raise ValueError(f"drops[{at}]: {error}") from None
    if outline.area(points) < outline.SHORTEST:
        raise ValueError(f"drops[{at}] encloses no floor: its points lie on one line")


def _in_words(error: str) -> str:
    """Put the path of a mistake first, and name the keys near to an unknown one."""
    problem, _, path = error.rpartition(" - at `$") if " - at `$" in error else (error, "", "")
    where = path.rstrip("`").lstrip(".")
    if problem.startswith("Object contains unknown field `"):
        key = problem.split("`")[1]
        problem = f"no key {key!r}; {nearest(key, _keys(where))}"
    elif problem.startswith("Invalid enum value "):
        colour = problem.split("'")[1]
        problem = f"no colour {colour!r}; {nearest(colour, get_args(Colour))}"
    return f"{where}: {problem}" if where else problem


def _keys(where: str) -> tuple[str, ...]:
    tables = {"start": Pose, "dock": Pose, "walls": Wall, "tapes": Tape, "posts": Post, "boxes": Box}
    return tables.get(where.partition("[")[0], Scene).__struct_fields__
