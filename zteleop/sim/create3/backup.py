"""How far a Create 3 may reverse: it cannot see what is behind it, so no further than it came from."""

BUFFER = 0.15
"""m at most"""
WARNED = 0.05
"""m that are left when it warns"""


class BackupLimit:
    """The way back that is known to be floor; none at the start."""

    def __init__(self) -> None:
        self.left = 0.0
        """m"""
        self.ignored = False
        """It reversed although warned, and has not gone forward since."""

    @property
    def is_near(self) -> bool:
        """Say whether it warns, or refuses already."""
        return self.left < WARNED

    @property
    def is_reached(self) -> bool:
        return self.left <= 0

    def roll(self, way: float) -> None:
        """Note that it went some m, back where negative."""
        self.left = max(0.0, min(BUFFER, self.left + way))
        if way > 0:
            self.ignored = False

    def reverse(self) -> None:
        """Note that somebody wants it to reverse."""
        self.ignored = self.ignored or self.is_near
