"""May a stream begin anew by itself? After a restart, if its owner says so; never after a stop."""

from zteleop.control.gate import Refusal
from zteleop.control.proof import NEVER
from zteleop.messages import DriveStatus, Refusals

NOT_BEGUN = (Refusal.EARLIER_START, Refusal.NOT_FROM_NEUTRAL, Refusal.LAPSED, Refusal.BEFORE_REPAIR)
"""What a claim is refused for that has only to begin anew."""
AT_MOST_EVERY = 1.0
"""s between two beginnings, in which the robot's answer to the first arrives"""


class Resume:
    """Lets a sender begin anew while the last stop is still the one that was over when it was obeyed.

    It asks the robot and not its own ears: a stop that was engaged and released while the link was cut
    needs a person just as well.
    """

    def __init__(self, sender: str) -> None:
        self._sender = sender
        self._released: int | None = None
        self._stopped = False
        self._answered: Refusals | None = None
        self._began = NEVER

    def heed(self, status: DriveStatus) -> None:
        """Take in what the robot does: a status that obeys this sender names the stop that was over then."""
        if status.operator == self._sender:
            self._released, self._stopped = status.released, False
        self._stopped |= bool(status.stops) or status.released != self._released

    def may(self, told: Refusals | None, now: float) -> bool:
        """Say whether to let go now, and begin anew; each word of the robot is answered once."""
        if told is None or told is self._answered or now - self._began <= AT_MOST_EVERY:
            return False
        self._answered = told
        why = next((refused.why for refused in told.refused if refused.sender == self._sender), None)
        if why not in NOT_BEGUN or told.rest or self._stopped or told.released != self._released:
            return False
        self._began = now
        return True
