"""What makes a black box write: the robot at rest for a reason that somebody will ask for."""

from collections import deque
from typing import NamedTuple

from zteleop.bus import codec
from zteleop.bus.tap import Raw
from zteleop.bus.topics import TOPICS
from zteleop.control.proof import NEVER
from zteleop.control.stop import REMEMBERED
from zteleop.errors import MessageError
from zteleop.messages import DriveStatus, Stop, WatchdogStatus
from zteleop.recording.ring import SECONDS

STATES = {"link lost": "link-lost", "operator idle": "operator-idle", "fault": "fault"}
"""States of the drive that are a reason, as a file's name says them."""
SAME_WITHIN = 5.0
"""s within which a state that comes back is no new reason, as long as the next file would still tell of it:
whoever speaks once a second is silent in between each time"""
STOP, ACTUATOR, WATCHDOG = "stop", "actuator-ended", "watchdog-ended"
_HEARD = {path: codec.decoders(TOPICS[path].types) for path in ("drive_status", "stop", "watchdog")}


class Trigger(NamedTuple):
    """A reason to write, the moment, and a sentence."""

    at: float
    reason: str
    why: str


class Triggers:
    """Finds the edges; what is so from the beginning is none."""

    def __init__(self) -> None:
        self._status: DriveStatus | None = None
        self._restarts: int | None = None
        self._seen: dict[str, float] = {}
        """when each state that is a reason was shown last"""
        self._told: dict[str, float] = {}
        """when it was one"""
        self._known: deque[int] = deque(maxlen=REMEMBERED)
        """the ids of stops that were reasons; they are said again and again"""

    def hear(self, raw: Raw) -> Trigger | None:
        """Return the reason that a message is, if it is one."""
        accepted = _HEARD.get(raw.path)
        if accepted is None or raw.deleted:
            return None
        try:
            message = codec.decode(raw.payload, raw.encoding, accepted)
        except MessageError:
            return None
        found = self._judge(message, raw.at)
        return Trigger(raw.at, *found) if found else None

    def _judge(self, message: object, at: float) -> tuple[str, str] | None:
        if isinstance(message, Stop):
            return self._hear_stop(message)
        if isinstance(message, WatchdogStatus):
            return self._hear_watchdog(message)
        return self._hear_status(message, at) if isinstance(message, DriveStatus) else None

    def _hear_stop(self, stop: Stop) -> tuple[str, str] | None:
        shown = _ids(self._status) if self._status else frozenset()
        if not stop.engaged or not stop.id or stop.id in shown or stop.id in self._known:
            return None  # said again, or by hand without an id, which only the status tells apart
        self._known.append(stop.id)
        if shown:
            return None  # of a robot that stands stopped already there is nothing new to see
        return STOP, f"stopped by {stop.by or 'somebody'}" + (f": {stop.why}" if stop.why else "")

    def _hear_status(self, status: DriveStatus, at: float) -> tuple[str, str] | None:
        before, self._status = self._status, status
        seen = self._seen.get(status.state, NEVER)
        if status.state in STATES:
            self._seen[status.state] = at
        if before is None:
            return None
        if new := _ids(status) - _ids(before) - set(self._known):
            self._known.extend(new - {0})
            return (STOP, status.why) if before.state != "stopped" else None
        if status.state == before.state or status.state not in STATES:
            return None
        if at - seen < SAME_WITHIN and at - self._told.get(status.state, NEVER) < SECONDS:
            return None
        self._told[status.state] = at
        return STATES[status.state], status.why

    def _hear_watchdog(self, dog: WatchdogStatus) -> tuple[str, str] | None:
        before, self._restarts = self._restarts, dog.restarts + (dog.state == "resting")
        if before is None or self._restarts <= before:
            return None
        return ACTUATOR, dog.why


def _ids(status: DriveStatus) -> frozenset[int]:
    return frozenset(stop.id for stop in status.stops)
