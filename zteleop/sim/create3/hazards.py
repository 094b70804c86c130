"""What a Create 3 feels of its scene: five bumpers in front, four eyes for a drop, and its wheels."""

from collections.abc import Iterable
from math import cos, pi
from typing import NamedTuple

from zteleop.control.create3 import TRACK
from zteleop.messages import HazardDetection, Header, Time
from zteleop.sim.surroundings import Surroundings

BACKUP_LIMIT, BUMP, CLIFF, STALL, WHEEL_DROP = range(5)
BUMPERS = ("bump_right", "bump_front_right", "bump_front_center", "bump_front_left", "bump_left")
"""Each a fifth of the front half, from the right to the left."""
CLIFFS = {
    "cliff_side_left": (0.06, 0.15),
    "cliff_front_left": (0.15, 0.05),
    "cliff_front_right": (0.15, -0.05),
    "cliff_side_right": (0.06, -0.15),
}
"""m ahead and to the left of base_link"""
WHEELS = {"wheel_drop_left": (0.0, TRACK / 2), "wheel_drop_right": (0.0, -TRACK / 2)}
GLANCING = 0.1
"""of the cosine between way and contact, below which it slides along"""


class Hazard(NamedTuple):
    type: int
    frame: str

    def message(self, stamp: Time) -> HazardDetection:
        return HazardDetection(Header(stamp, self.frame), self.type)


class Touch(NamedTuple):
    """What it feels now."""

    contacts: tuple[float, ...] = ()
    """bearings, rad"""
    bumps: tuple[str, ...] = ()
    cliffs: tuple[str, ...] = ()
    drops: tuple[str, ...] = ()

    def is_against(self, way: float) -> bool:
        """Say whether something touches it on the side to which it wants to go."""
        return any(cos(bearing) * way > GLANCING * abs(way) for bearing in self.contacts)

    @property
    def hazards(self) -> list[Hazard]:
        kinds = ((BUMP, self.bumps), (CLIFF, self.cliffs), (WHEEL_DROP, self.drops))
        return [Hazard(kind, frame) for kind, frames in kinds for frame in frames]


def touch(around: Surroundings) -> Touch:
    """Return what is felt of the surroundings."""
    contacts = tuple(around.contacts)
    return Touch(contacts, _bumps(contacts), _without_floor(around, CLIFFS), _without_floor(around, WHEELS))


def _bumps(contacts: Iterable[float]) -> tuple[str, ...]:
    fifths = {int((bearing + pi / 2) // (pi / 5)) for bearing in contacts if abs(bearing) <= pi / 2}
    return tuple(BUMPERS[min(fifth, 4)] for fifth in sorted(fifths))


def _without_floor(around: Surroundings, places: dict[str, tuple[float, float]]) -> tuple[str, ...]:
    return tuple(name for name, (ahead, left) in places.items() if not around.is_floor(ahead, left))
