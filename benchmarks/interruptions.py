"""When a robot was at rest although somebody drove it, as its chip tells; and why, as its journal does."""

import json
import re
import time
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

from robot import ROBOT, Robot

from zteleop.drivers.registers import read_duty_ticks

THROTTLE = 0
COMES_BACK = 3.0
"""s after which who has not come back never will: 2 s for the link, a beat, a round trip, a busy machine"""
SLACK = 0.05
"""s by which a chip may be seen at rest after its journal says why"""
NAMES = re.compile(r"\b(?=[0-9a-f]*\d)[0-9a-f]{4,}\b")
NUMBERS = re.compile(r"\d+(\.\d+)?")


class Interruption(NamedTuple):
    """A time at rest, in the bus clock's seconds; `over` is None when it had not ended at the end."""

    began: float
    over: float | None


class Witness:
    """Looks at the throttle of one robot, again and again."""

    def __init__(self, robot: Robot) -> None:
        self.robot, self._rest = robot, self._ticks(robot)
        self.interruptions: list[Interruption] = []
        self._resting_since: float | None = None
        self.began = self._ended = 0.0

    @property
    def moves(self) -> bool:
        """Say whether the chip puts out a pulse that drives; none at all drives nobody."""
        return self._ticks(self.robot) not in (None, self._rest)

    def begin(self, now: float) -> None:
        """Count from now; who is at rest now is interrupted from the start."""
        self.began, self._resting_since = now, None

    def look(self, now: float) -> None:
        """Note what has changed since the last look."""
        if self.moves:
            self._go_on(now)
        elif self._resting_since is None:
            self._resting_since = now

    def end(self, now: float) -> None:
        """Close the account: who is at rest now has not come back."""
        self._ended = now
        if self._resting_since is not None:
            self.interruptions.append(Interruption(self._resting_since, None))

    @property
    def lasted(self) -> list[float]:
        """Return the seconds of each interruption."""
        return [(self._ended if over is None else over) - began for began, over in self.interruptions]

    @property
    def share(self) -> float:
        """Return the share of the time driven, in %."""
        return 100 * (1 - sum(self.lasted) / (self._ended - self.began))

    @property
    def unfinished(self) -> bool:
        """Say whether it is at rest at the end."""
        return any(over is None for _, over in self.interruptions)

    @property
    def locked_out(self) -> bool:
        """Say whether it is at rest at the end, and for longer than any that comes back by itself."""
        return self.unfinished and self.lasted[-1] > COMES_BACK

    def causes(self) -> Counter[str]:
        """Return how often what was the cause, in the robot's words, for as long as it keeps its folder."""
        events = journal(Path(self.robot.folder))
        return Counter(_cause(interruption, events) for interruption in self.interruptions)

    def _go_on(self, now: float) -> None:
        if self._resting_since is not None:
            self.interruptions.append(Interruption(self._resting_since, now))
            self._resting_since = None

    @staticmethod
    def _ticks(robot: Robot) -> int | None:
        return read_duty_ticks(robot.registers.snapshot(), THROTTLE)


def journal(folder: Path) -> list[dict[str, Any]]:
    """Return what a robot wrote down of its states; nobody has to be on its bus for it."""
    time.sleep(0.5)  # until it is on the disk
    place = folder / "zteleop" / "robots" / ROBOT
    files = [place / "journal.old", place / "journal.jsonl"]
    lines = [line for file in files if file.exists() for line in file.read_bytes().splitlines() if line]
    return [event for event in map(json.loads, lines) if event["event"] in ("state", "start")]


def _cause(interruption: Interruption, events: list[dict[str, Any]]) -> str:
    """Return the first word of the robot on why it came to rest then."""
    over = interruption.over or float("inf")
    for event in events:
        if interruption.began - SLACK <= event["at"] <= over:
            if event["event"] == "start":
                return "the actuator was ended, and started again"
            if event["state"] != "driving":
                return NUMBERS.sub("#", NAMES.sub("X", f"{event['state']}: {event['why']}"))
    return "the journal does not say"
