"""How a twist tells a car where its wheels point, even while it stands.

A standing car has no yaw rate to command, so (0, w) means the curvature that w
would be at `STANDSTILL` speed: the wheels can be turned before driving off.
"""

STANDSTILL = 0.1
"""m/s"""
CRAWL = 1e-3
"""m/s below which a car stands: dividing by less would make a curvature of anything."""


def of(speed: float, turn: float) -> float:
    """Return the curvature, in 1/m, of a speed in m/s and a yaw rate in rad/s."""
    return turn / _rolling(speed)


def turn(speed: float, curvature: float) -> float:
    """Return the yaw rate, in rad/s, that keeps a curvature at a speed."""
    return _rolling(speed) * curvature


def rolls(speed: float) -> bool:
    """Say whether a car moves at all at this speed in m/s."""
    return abs(speed) >= CRAWL


def _rolling(speed: float) -> float:
    return speed if rolls(speed) else STANDSTILL
