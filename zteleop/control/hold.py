"""Reasons to keep the robot at rest, whoever claims it: a stop, a fault, an ESC that arms."""

from typing import NamedTuple

from zteleop.messages import State

HOLDS: tuple[State, ...] = ("fault", "stopped", "starting")
"""States of a hold after which everybody begins anew; of several reasons the first of these is shown."""
PAUSE: State = "link lost"
"""The state of a hold that ends as an interruption does, and is shown after all others."""


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

    def __contains__(self, reason: str) -> bool:
        return reason in self._holds

    @property
    def in_order(self) -> list[Hold]:
        """All reasons, the one to tell people first."""
        return sorted(self._holds.values(), key=lambda hold: (*HOLDS, PAUSE).index(hold.state))

    @property
    def strongest(self) -> Hold | None:
        """The reason to tell people where there is room for one."""
        return next(iter(self.in_order), None)

    @property
    def pass_by_themselves(self) -> bool:
        """None of the reasons takes a claim's right to go on."""
        return all(hold.state == PAUSE for hold in self._holds.values())

    def add(self, reason: str, state: State, why: str, now: float) -> None:
        """Add a reason, or say an old one in new words."""
        since = self._holds[reason].since if reason in self._holds else now
        self._holds[reason] = Hold(state, why, since)

    def drop(self, reason: str) -> Hold | None:
        """Drop a reason, and return what it was."""
        return self._holds.pop(reason, None)
