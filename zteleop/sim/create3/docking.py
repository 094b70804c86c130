"""Whether a Create 3 stands in its dock, and whether it sees it: by where the dock is from base_link."""

from math import atan2, hypot, radians

from zteleop.messages import DockStatus, Header

Place = tuple[float, float, float]
"""m ahead, m to the left, and the rad that a docked robot would look to from here."""
WITHIN, ASLANT = 0.04, radians(10)
"""m and rad by which it may be off and still have its contacts on the dock's"""
SEEN, SIDE = 1.0, radians(60)
"""m, and rad to either side of ahead, in which its infrared light reaches the robot"""


def is_docked(dock: Place | None) -> bool:
    """Say whether it stands in the dock."""
    return dock is not None and hypot(dock[0], dock[1]) <= WITHIN and abs(dock[2]) <= ASLANT


def is_seen(dock: Place | None) -> bool:
    """Say whether it sees the dock, or stands in it."""
    if dock is None:
        return False
    ahead, left, _ = dock
    return is_docked(dock) or (hypot(ahead, left) <= SEEN and abs(atan2(left, ahead)) <= SIDE)


def status(header: Header, dock: Place | None) -> DockStatus:
    """Return what it tells of its dock."""
    return DockStatus(header, is_seen(dock), is_docked(dock))
