"""The circle that a path goes round: how a radius is measured, from odometry or from a trail on a screen."""

from collections.abc import Sequence
from itertools import pairwise
from math import copysign, hypot, sqrt
from typing import NamedTuple

Path = Sequence[tuple[float, float]]
STRAIGHT = 0.005
"""Off a line, as a part of its length, below which a path is straight; an arc of 2 degrees."""
PRECISION = 0.05
"""Part of a radius, by which noise may change it: where it may do more, the points tell no radius."""
STEPS = 20
ENOUGH = 5
"""Points of an arc that is looked for: two of them might only be where another one ended."""
MOST = 100
"""Points looked back."""
NEAR = 0.01
"""m that a point may be off the arc it belongs to."""


class Circle(NamedTuple):
    """A circle in the frame of its points, m."""

    x: float
    y: float
    radius: float
    """positive where the path goes round it to the left, as a positive yaw rate does"""

    def off(self, point: tuple[float, float]) -> float:
        """Return how many m a point is away from the circle."""
        return abs(hypot(point[0] - self.x, point[1] - self.y) - abs(self.radius))


def fit_circle(points: Path) -> Circle | None:
    """Return the circle that a path of three points or more goes round (Taubin's fit, m).

    None for a straight line, for fewer points, and for points that no circle explains.
    """
    if len(points) < 3:
        return None
    x, y = (sum(values) / len(points) for values in zip(*points, strict=True))
    centred = [(px - x, py - y) for px, py in points]
    found = taubin(centred)
    if found is None:
        return None
    circle = Circle(found.x, found.y, copysign(found.radius, swept(centred, found)))
    return Circle(x + circle.x, y + circle.y, circle.radius)


def last_arc(points: Path) -> Circle | None:
    """Return the circle that a path went round at its end, as far back as one circle explains it."""
    found = None
    count = ENOUGH
    while count <= len(points[-MOST:]):
        end = points[-count:]
        circle = fit_circle(end)
        if circle is None or max(map(circle.off, end)) > NEAR:
            break
        found = circle
        count = max(count + 1, min(count * 3 // 2, len(points)))
    return found


def rms_off(circle: Circle, points: Path) -> float:
    """Return how far points are off a circle, m, as the root of the mean square."""
    return sqrt(sum(circle.off(point) ** 2 for point in points) / len(points))


def taubin(points: Path) -> Circle | None:
    """Return the circle nearest to points whose mean is the origin, with a positive radius."""
    xx = yy = xy = xz = yz = zz = 0.0
    for x, y in points:
        z = x * x + y * y
        xx, yy, xy = xx + x * x, yy + y * y, xy + x * y
        xz, yz, zz = xz + x * z, yz + y * z, zz + z * z
    xx, yy, xy, xz, yz, zz = (total / len(points) for total in (xx, yy, xy, xz, yz, zz))
    across, along = spreads(xx, yy, xy)
    if across <= STRAIGHT**2 * along:
        return None
    z, spread = xx + yy, xx * yy - xy * xy
    root = smallest_root(
        (
            xz * xz * yy + yz * yz * xx - zz * spread - 2 * xz * yz * xy + z * z * spread,
            zz * z + 4 * spread * z - xz * xz - yz * yz - z**3,
            -3 * z * z - zz,
            4 * z,
        )
    )
    divisor = 2 * (root * root - root * z + spread)
    if divisor <= 0:
        return None
    x = (xz * (yy - root) - yz * xy) / divisor
    y = (yz * (xx - root) - xz * xy) / divisor
    circle = Circle(x, y, sqrt(x * x + y * y + z))
    return circle if tells(across, rms_off(circle, points), len(points)) else None


def tells(across: float, off: float, count: int) -> bool:
    """Say whether so many points, so far off a line (m^2) and off a circle (m), tell its radius."""
    # an F-test: what a bend explains, against what is left for each of the other points
    return (across - off * off) * (count - 3) * PRECISION**2 >= off * off or count == 3


def spreads(xx: float, yy: float, xy: float) -> tuple[float, float]:
    """Return the least and the most variance of points, over all directions."""
    middle, reach = (xx + yy) / 2, hypot((xx - yy) / 2, xy)
    return max(0.0, middle - reach), middle + reach


def smallest_root(factors: tuple[float, float, float, float]) -> float:
    """Return the root next to 0 of a cubic that falls towards it, by Newton's steps."""
    a, b, c, d = factors
    x, value = 0.0, a
    for _ in range(STEPS):
        slope = b + x * (2 * c + x * 3 * d)
        if not slope:
            break
        after = x - value / slope
        then = a + after * (b + after * (c + after * d))
        if after == x or abs(then) >= abs(value):
            break
        x, value = after, then
    return x


def swept(points: Path, circle: Circle) -> float:
    """Return twice the area that a path sweeps as seen from the middle of a circle; positive to the left."""
    around = [(x - circle.x, y - circle.y) for x, y in points]
    return sum(x * then_y - y * then_x for (x, y), (then_x, then_y) in pairwise(around))
