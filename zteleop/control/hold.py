"""Reasons to keep the robot at rest, whoever claims it: a stop, a fault, an ESC that arms."""

from typing import NamedTuple

from zteleop.messages import State

HOLDS: tuple[State, ...] = ("stopped", "fault", "starting")
"""States of a hold; of several reasons the first of these is shown."""


class Hold(NamedTuple):
    """One reason, and since when."""

    state: State
    why: str
    since: float


class Holds:
    """Every reason by its name; the robot is free when there is none."""

    def __init__(self) -> None:
        self._holds: dict[str, Hold] = {}

    def __bool__(self) -> bool:
        return bool(self._holds)

    @property
    def strongest(self) -> Hold | None:
        """The reason to tell people."""
        return min(self._holds.values(), key=lambda hold: HOLDS.index(hold.state), default=None)

    def add(self, reason: str, state: State, why: str, now: float) -> None:
        """Add a reason, or say an old one in new words."""
        since = self._holds[reason].since if reason in self._holds else now
        self._holds[reason] = Hold(state, why, since)

    def drop(self, reason: str) -> bool:
        """Drop a reason; True when it was one."""
        return self._holds.pop(reason, None) is not None
