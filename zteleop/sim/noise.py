"""How far what a robot senses is from the truth: spreads of chance, each a standard deviation."""

from typing import Annotated

from msgspec import Meta, Struct

Spread = Annotated[float, Meta(ge=0, le=1)]


class Noise(Struct, frozen=True, forbid_unknown_fields=True):
    """Chance errors without a bias; what wheels get wrong grows with the root of the way, as drift does."""

    way: Spread = 0.0
    """m that odometry is off ahead after one metre, and ten times that after a hundred"""
    turn: Spread = 0.0
    """rad that its heading is off after a turn of one rad"""
    drift: Spread = 0.0
    """rad that its heading is off after one metre"""
    range: Spread = 0.0
    """m, of each reading of a range sensor"""
    gyro: Spread = 0.0
    """rad/s, of each reading of an inertial unit"""

    @property
    def moves(self) -> bool:
        """Say whether odometry is more than exact."""
        return (self.way, self.turn, self.drift) != (0.0, 0.0, 0.0)


NONE = Noise()
LEVELS = {
    "none": NONE,
    "low": Noise(way=0.01, turn=0.01, drift=0.01, range=0.005, gyro=0.002),
    "high": Noise(way=0.05, turn=0.05, drift=0.05, range=0.03, gyro=0.02),
}
"""What can be asked for by name: exact; a good robot on a good floor; cheap wheels on a carpet."""
