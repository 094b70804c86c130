"""What stands in the way of a robot, told to the program that drives against it."""

from collections.abc import Callable

from zteleop.bus import clock
from zteleop.bus.answer import Answer
from zteleop.bus.subscription import Subscription
from zteleop.messages import Log

TOLD_BY = "sim"
"""who moves the body, and knows what that touches; all else the robot answers itself"""
LOOK_EVERY = 0.3
"""s"""


class InTheWay:
    """Hands on what is said of a robot's body while `answer`'s program moves it; `tell` hears a sentence."""

    def __init__(
        self, logs: Subscription[Log], robot: str, answer: Answer, tell: Callable[[str], object]
    ) -> None:
        self._logs = logs
        self._robot = robot
        self._answer = answer
        self._tell = tell

    def look(self) -> float:
        """Take in what was said since the last look; return when to look again."""
        for received in self._logs.take():
            said = received.message
            if said.name == TOLD_BY and said.level >= Log.WARN and self._answer.moves:
                self._tell(f"robot {self._robot} does not move on, says its {TOLD_BY}: {said.msg}")
        return clock.now() + LOOK_EVERY
