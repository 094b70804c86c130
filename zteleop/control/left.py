"""Who drove, and drives no more, while nobody else does: what the robot rests for."""

from typing import NamedTuple

from zteleop.messages import State

EARLY = 0.1
"""s before the operator's deadline at which an input that knows it may let go"""


class Left(NamedTuple):
    """Who drives no more, and since when."""

    who: str
    at: float
    is_idle: bool = False
    """it let go because nobody had acted for too long; of others the link, or the process, is lost"""

    def told(self, limit: float) -> tuple[State, str]:
        """Return the state of a robot that nobody else has driven since, and why."""
        if self.is_idle:
            return "idle", f"nobody drives; {self.who} had not acted for {limit:g} s"
        gone = "is not heard any more: ended, suspended or cut off"
        return "link lost", f"{self.who} {gone}; whoever begins drives"
