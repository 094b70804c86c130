"""How fast, and how tightly, a vehicle goes round: chosen so that nothing of it is scaled down."""

from math import floor, inf

from zteleop.control.stick import tightest
from zteleop.messages import Vehicle

EASY = 0.5
"""m/s that anybody can run after"""
BRISK = 1.5
"""rad/s that nothing on top falls over by"""
SHARE = 0.8
"""of what a vehicle can do, so that there is room to correct"""
ROOM = 1.25
"""times its least radius is how tightly a car plans to go round, so that it can correct"""


def least_radius(vehicle: Vehicle) -> float:
    """Return the m of the tightest circle that a vehicle drives; 0 where it turns on the spot."""
    return 1 / tightest(vehicle) if vehicle.steers else 0.0


def easy_radius(vehicle: Vehicle) -> float:
    """Return the m of the tightest circle that a vehicle plans to drive; 0 where it turns on the spot."""
    return ROOM * least_radius(vehicle)


def straight_speed(vehicle: Vehicle) -> float:
    """Return the m/s at which a vehicle goes ahead easily."""
    return _rounded(min(EASY, SHARE * vehicle.max_speed))


def circle_speed(vehicle: Vehicle, radius: float) -> float:
    """Return the m/s at which a vehicle goes round a circle, m, with the outer wheel in its bounds."""
    speed = min(vehicle.max_speed / (1 + _half_track(vehicle) / radius), vehicle.max_turn * radius)
    return _rounded(min(EASY, speed))


def turn_speed(vehicle: Vehicle) -> float:
    """Return the rad/s at which a vehicle turns on the spot."""
    return min(BRISK, SHARE * vehicle.max_turn)


def _half_track(vehicle: Vehicle) -> float:
    """Return the m from the middle to a wheel that the vehicle's own bounds amount to; of a car, nothing."""
    if vehicle.steers:
        return 0.0
    return vehicle.max_speed / vehicle.max_turn if vehicle.max_turn else inf


def _rounded(speed: float) -> float:
    """Return a speed rounded down to whole cm/s, as people type it."""
    return floor(speed * 100) / 100 if speed >= 0.02 else speed
