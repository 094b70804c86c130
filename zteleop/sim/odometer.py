"""Where a body believes it is, by what its wheels turned since it was switched on (odom, REP-105)."""

from math import cos, remainder, sin, sqrt, tau
from random import Random

from zteleop.control.motion.pose import Pose2D
from zteleop.sim.noise import NONE, Noise

XX, XY, XH, YX, YY, YH, HX, HY, HH = 0, 1, 5, 6, 7, 11, 30, 31, 35
"""Where x, y and heading stand in a 6 x 6 covariance."""


class Odometer:
    """Counts from 0, 0, 0; without noise it errs only where a body is pushed aside."""

    def __init__(self, noise: Noise = NONE, chance: Random | None = None) -> None:
        self.noise = noise
        self._chance = chance or Random(0)
        self.distance = 0.0
        """m rolled since the start, back and forth."""
        self.reset()

    def reset(self) -> None:
        """Call the place where it is 0, 0, 0."""
        self.x = self.y = self.heading = 0.0
        self._xx = self._xy = self._yy = self._xh = self._yh = self._hh = 0.0

    def add(self, way: float, turn: float) -> None:
        """Count a short way (m) and turn (rad) of the wheels."""
        self.distance += abs(way)
        if self.noise.moves:
            way, turn = self._err(way, turn)
        middle = self.heading + turn / 2
        self.x += way * cos(middle)
        self.y += way * sin(middle)
        self.heading = remainder(self.heading + turn, tau)

    @property
    def pose(self) -> Pose2D:
        return Pose2D(self.x, self.y, self.heading)

    @property
    def covariance(self) -> list[float]:
        """Of the pose, 6 x 6 in rows; zeros are exact, as without noise."""
        found = [0.0] * 36
        found[XX], found[YY], found[HH] = self._xx, self._yy, self._hh
        found[XY] = found[YX] = self._xy
        found[XH] = found[HX] = self._xh
        found[YH] = found[HY] = self._yh
        return found

    def _err(self, way: float, turn: float) -> tuple[float, float]:
        """Return what the wheels tell of a way and a turn, and note how wrong that may be."""
        ahead = self.noise.way**2 * abs(way)
        aside = self.noise.turn**2 * abs(turn) + self.noise.drift**2 * abs(way)
        middle = self.heading + turn / 2
        self._spread(way * cos(middle), way * sin(middle), ahead, aside, middle)
        return way + self._chance.gauss(0, sqrt(ahead)), turn + self._chance.gauss(0, sqrt(aside))

    def _spread(self, dx: float, dy: float, ahead: float, aside: float, heading: float) -> None:
        """Carry the covariance over a step: an error of heading moves the place, too."""
        c, s = cos(heading), sin(heading)
        self._xx += dy * (dy * self._hh - 2 * self._xh) + ahead * c * c
        self._yy += dx * (dx * self._hh + 2 * self._yh) + ahead * s * s
        self._xy += dx * self._xh - dy * self._yh - dx * dy * self._hh + ahead * c * s
        self._xh -= dy * self._hh
        self._yh += dx * self._hh
        self._hh += aside
