"""A body in a scene: what it runs into, and how far it is to whatever stands ahead."""

from collections.abc import Sequence
from math import atan2, pi, remainder, tau
from typing import NamedTuple

from zteleop.control.motion.pose import Pose2D
from zteleop.errors import ConfigError
from zteleop.sim import outline, ranges
from zteleop.sim.body import Disc
from zteleop.sim.obstacles import Obstacles, Side, away, clearance
from zteleop.sim.scene import Point, Scene

AHEAD = 0.3
"""m for which the sides that are near stay known"""


class Contact(NamedTuple):
    """What a body stands at, in the words of the scene, and where: a bearing, rad; None for a drop."""

    name: str
    bearing: float | None


class World:
    """The surroundings of a body of these discs, whose odom frame begins where the scene starts.

    Raises ConfigError for a scene that has no room for the body there.
    """

    def __init__(self, scene: Scene, discs: Sequence[Disc]) -> None:
        self._start = Pose2D(scene.start.x, scene.start.y, scene.start.heading)
        self._scene = scene
        self._obstacles = Obstacles(scene)
        self._known: tuple[Pose2D, list[Side]] | None = None
        """The sides that were near at a place; they are looked for anew once it is far from there."""
        self._discs = discs
        self._reach = max(abs(disc.ahead) + disc.radius for disc in discs)
        self.pose = self._start
        """Where the body is, in the frame of the scene."""
        self.contact: Contact | None = None
        """What it runs into, until it moves again."""
        self.pushed = False
        """It wanted to go on into that since somebody last looked, who says False then."""
        found = self._hit(self.pose, None)
        if name := self._obstacles.filled(self.pose.x, self.pose.y) or (found and found.name):
            raise ConfigError(f"a robot does not fit where the scene starts: {name} is there")

    @property
    def nose(self) -> float:
        """How far ahead of base_link the body reaches, m."""
        return max(disc.ahead + disc.radius for disc in self._discs)

    @property
    def contacts(self) -> list[float]:
        """Bearings, rad, of what touches the body."""
        bearing = self.contact.bearing if self.contact else None
        return [] if bearing is None else [bearing]

    def admits(self, before: Pose2D, after: Pose2D) -> bool:
        """Say whether the body may go from one pose of the odom frame to the next, and is there then.

        It may always go away from what it touches.
        """
        if after == before:
            return True
        here, there = (self._start.ahead(pose.x, pose.y, pose.heading) for pose in (before, after))
        self.contact = self._hit(there, here)
        self.pushed = self.pushed or self.contact is not None
        self.pose = here if self.contact else there
        return not self.contact

    def is_floor(self, ahead: float, left: float) -> bool:
        """Say whether there is floor at that place."""
        place = self.pose.ahead(ahead, left)
        return self._drop([(place.x, place.y)]) is None

    def distance(self, ahead: float, left: float, bearing: float, longest: float) -> float:
        """Return the m from that place to the nearest wall or obstacle along a bearing; at most `longest`."""
        place = self.pose.ahead(ahead, left, bearing)
        return ranges.distance(self._obstacles.runs, place.x, place.y, place.heading, longest)

    def dock(self) -> tuple[float, float, float] | None:
        """Return ahead, left and bearing of where a docked robot stands and looks; None without a dock."""
        if not (dock := self._scene.dock):
            return None
        return *self.pose.local(dock.x, dock.y), remainder(dock.heading - self.pose.heading, tau)

    def _hit(self, after: Pose2D, before: Pose2D | None) -> Contact | None:
        """Return something that the body is in, and was not so deep in before; poses of the scene's frame."""
        sides = self._near(after)
        if not sides and not self._scene.drops:
            return None
        here, there = self._middles(after), self._middles(before) if before else None
        for side in sides:
            gap = self._gap(side, here)
            if gap < 0 and (there is None or gap < self._gap(side, there)):
                return Contact(side.name, self._bearing(side, after, here))
        drop = self._drop(here)
        return Contact(drop, None) if drop and not (there and self._drop(there)) else None

    def _near(self, place: Pose2D) -> list[Side]:
        """Return all sides that the body may touch at a place, and perhaps some more."""
        if self._known is None or self._known[0].distance(place.x, place.y) > AHEAD:
            self._known = place, self._obstacles.near(place.x, place.y, self._reach + AHEAD)
        return self._known[1]

    def _drop(self, places: Sequence[Point]) -> str | None:
        """Return the name of a drop that one of these places is over."""
        for at, points in enumerate(self._scene.drops):
            if any(outline.encloses(points, x, y) for x, y in places):
                return f"drops[{at}]"
        return None

    def _middles(self, place: Pose2D) -> list[Point]:
        return [place.ahead(disc.ahead)[:2] for disc in self._discs]

    def _gap(self, side: Side, middles: Sequence[Point]) -> float:
        """Return the m between a side and the body; less than 0 where one is in the other."""
        return min(
            clearance(side, x, y) - disc.radius for disc, (x, y) in zip(self._discs, middles, strict=True)
        )

    def _bearing(self, side: Side, place: Pose2D, middles: Sequence[Point]) -> float:
        """Return where the nearest of a side is, seen from base_link."""
        _, (x, y) = min(
            (clearance(side, x, y) - disc.radius, (x, y))
            for disc, (x, y) in zip(self._discs, middles, strict=True)
        )
        dx, dy = away(side, x, y)
        return remainder(atan2(dy, dx) + pi - place.heading, tau)
