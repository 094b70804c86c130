"""How fast may it go? Only so fast that it stops in time should the link die now, and as its supply bears."""

from collections import deque
from collections.abc import Mapping
from math import sqrt
from typing import Annotated, Literal, NamedTuple

from msgspec import Meta, Struct

from zteleop.control.mux import Source

GOOD_LATENCY = 0.15
"""s; no link counts as better, so that none this good is slowed down, and nothing wavers with it."""
WINDOW = 5.0
"""s that an age counts."""
SLOT, SLOTS = 0.02, 256
"""s of which only the worst age is kept, so that a flood pushes none out; and how many are."""
REFRESH = 0.2
"""s between two looks at all the ages."""


class CapSettings(Struct, frozen=True, forbid_unknown_fields=True):
    """Within what distance it stops when the link dies."""

    stopping_distance: Annotated[float, Meta(ge=0.1, le=1000)] | None = None
    """m from the last command to rest; None is no farther than from full speed on a good link"""
    rollout: Annotated[float, Meta(ge=0.05, le=100)] = 1.0
    """m/s^2 by which the vehicle slows down while nobody drives; only `stopping_distance` needs it"""

    def speed(self, top: float, latency: float, silence: float) -> float:
        """Return the highest speed, in m/s and at most `top`, on a link of this latency, in s.

        `silence`, in s, is what passes without a command until neutral.
        """
        blind = max(latency, GOOD_LATENCY) + silence
        if self.stopping_distance is None:  # a shorter way until neutral is a shorter way, however it rolls
            return top * ((GOOD_LATENCY + silence) / blind)
        twice = 2 * self.stopping_distance
        return min(top, twice / (blind + sqrt(blind * blind + twice / self.rollout)))

    def distance(self, speed: float, latency: float, silence: float) -> float:
        """Return how far it goes, in m, when the link dies at this speed: on until neutral, then out."""
        return speed * (latency + silence) + speed * speed / (2 * self.rollout)


class Strain(NamedTuple):
    """How much of its speed the robot can bear now, above 0 and at most 1, and why."""

    share: float
    why: str


AT_EASE = Strain(1.0, "")


Reason = Literal["vehicle", "source", "link", "strain", "parameter"]


class Bound(NamedTuple):
    """How fast the robot may be, in m/s, and what says so."""

    speed: float
    by: Reason
    latency: float
    """s; the 99th percentile of how old the driver's commands are; 0 when nobody drives"""


class Ages:
    """How old the commands of one sender were on arrival, of late."""

    def __init__(self, sender: int) -> None:
        self.sender = sender
        self._ages: deque[float] = deque(maxlen=SLOTS)
        self._times: deque[float] = deque(maxlen=SLOTS)
        self.bound: Bound | None = None
        self.until = 0.0
        """When the bound is to be found again."""

    def note(self, age: float, now: float) -> None:
        """Keep an age, in s, if it is the worst of its slot."""
        if self._times and now - self._times[-1] < SLOT:
            self._ages[-1] = max(self._ages[-1], age)
        else:
            self._ages.append(age)
            self._times.append(now)

    def p99(self, now: float) -> float:
        """Return the 99th percentile, which of less than a hundred is the worst; 0 when there is none."""
        while self._times and now - self._times[0] > WINDOW:
            self._times.popleft()
            self._ages.popleft()
        ranked = sorted(self._ages)
        return ranked[(99 * len(ranked) - 1) // 100] if ranked else 0.0


class Cap:
    """Follows the link of whoever drives each source, and the strain on the robot; never speeds it up."""

    def __init__(self, settings: CapSettings, top: float, sources: Mapping[str, Source]) -> None:
        self._settings = settings
        self.top = top
        self._sources = sources
        self._ages: dict[str, Ages] = {}
        self._tuned = top
        """m/s that somebody has set while it ran"""
        self.strain = AT_EASE

    def note(self, source: str, sender: int, age: float, now: float) -> None:
        """Take in the age, in s, of a command that drives."""
        ages = self._ages.get(source)
        if ages is None or ages.sender != sender:
            ages = self._ages[source] = Ages(sender)
        ages.note(age, now)

    def note_late(self, source: str, sender: int, age: float, now: float) -> None:
        """Take in a command that came too late to drive, if it is of the sender that drove last."""
        ages = self._ages.get(source)
        if ages and ages.sender == sender:
            ages.note(age, now)

    def bear(self, strain: Strain) -> None:
        """Learn how much the robot can bear."""
        if strain != self.strain:
            self.strain = strain
            self._find_anew()

    def tune(self, speed: float) -> None:
        """Learn how fast, in m/s, it may go now; never faster than the settings say."""
        self._tuned = min(speed, self.top)
        self._find_anew()

    def rest(self) -> Bound:
        """Return what bounds whoever may drive next."""
        return _least([(self.top, "vehicle"), (self._tuned, "parameter"), self._borne], 0.0)

    def find(self, source: str, now: float) -> Bound:
        """Return what bounds the driver of a source; found anew five times a second."""
        ages = self._ages.get(source)
        if ages is None:
            return self.rest()
        if ages.bound is None or not ages.until - REFRESH <= now < ages.until:
            ages.bound, ages.until = self._find(source, ages.p99(now)), now + REFRESH
        return ages.bound

    def _find(self, source: str, latency: float) -> Bound:
        its = self._sources[source]
        speed = self._settings.speed(self.top, latency, its.silence)
        own = its.max_speed or self.top
        bounds: list[tuple[float, Reason]] = [
            (self.top, "vehicle"),
            (self._tuned, "parameter"),
            (own, "source"),
            (speed, "link"),
            self._borne,
        ]
        return _least(bounds, latency)

    def _find_anew(self) -> None:
        for ages in self._ages.values():
            ages.bound = None

    @property
    def _borne(self) -> tuple[float, Reason]:
        return self.top * self.strain.share, "strain"


def _least(bounds: list[tuple[float, Reason]], latency: float) -> Bound:
    return Bound(*min(bounds, key=lambda bound: bound[0]), latency)
