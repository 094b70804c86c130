"""How a twist tells a car where its wheels point, even while it stands.

A standing car has no yaw rate to command, so (0, w) means the curvature that w
would be at `STANDSTILL` speed: the wheels can be turned before driving off.
"""

STANDSTILL = 0.1
"""m/s"""


def of(speed: float, turn: float) -> float:
    """Return the curvature, in 1/m, of a speed in m/s and a yaw rate in rad/s."""
    return turn / (speed or STANDSTILL)


def turn(speed: float, curvature: float) -> float:
    """Return the yaw rate, in rad/s, that keeps a curvature at a speed."""
    return (speed or STANDSTILL) * curvature
