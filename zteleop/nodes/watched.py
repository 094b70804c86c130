"""Whether somebody still watches this actuator: its watchdog's silence ends it, at the moment it is one."""

from collections.abc import Callable

from zteleop.bus import clock
from zteleop.bus.loop import Loop
from zteleop.control.deadlines import WATCHDOG_SILENCE
from zteleop.errors import DeviceError
from zteleop.machine.link import UNWATCHED

A_MOMENT = 0.001
"""s past the deadline"""


class UnwatchedError(DeviceError):
    """Nobody watches, so the actuator ends, at rest; a watchdog that was only late starts another."""

    exit_code = UNWATCHED


class Watched:
    """Counts the watchdog's silence, by an alarm of its own: a step may come late, or seldom."""

    def __init__(self, loop: Loop, notice_pause: Callable[[float], None], now: float) -> None:
        self._alarm = loop.alarm(self._miss)
        self._notice_pause = notice_pause
        self.since(now)

    def since(self, now: float) -> None:
        """Count its silence from now on: it was heard, or nobody could hear it before."""
        self._last = now
        self._alarm.ring_at(now + WATCHDOG_SILENCE)

    def _miss(self) -> None:
        """Raise UnwatchedError, unless this process stood still itself: then its word may wait unread."""
        now = clock.now()
        self._notice_pause(now)
        if (silent := now - self._last) >= WATCHDOG_SILENCE:
            raise UnwatchedError(f"the watchdog has been silent for {silent:.1f} s; the robot is at rest")
        self._alarm.ring_at(self._last + WATCHDOG_SILENCE + A_MOMENT)  # rounding, or a pause that it noticed
