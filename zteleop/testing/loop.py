"""A node's loop in a test's time."""

from collections.abc import Callable

from zteleop.bus.loop import Timer
from zteleop.testing.clock import Clock

Action = Callable[[], object]


class FakeLoop:
    """Runs what is due when a test lets time pass."""

    def __init__(self, clock: Clock) -> None:
        self.clock = clock
        self.timers: list[Timer] = []
        self._periods: list[float | None] = []
        self.watched: dict[int, Action] = {}
        """What is done when a file can be read."""
        self.stopped = False
        self.awake_since = float("-inf")
        """When it last woke from standing still."""

    def every(self, period: float, action: Action) -> Timer:
        """Run an action every `period` seconds, the first time at once."""
        return self._add(Timer(period, action, self.clock.time, self.clock.time))

    def alarm(self, action: Action) -> Timer:
        """Return a timer that runs an action once, whenever it is set."""
        return self._add(Timer(None, action, float("inf")))

    def call_soon(self, action: Action) -> None:
        """Run an action; in a test that is now."""
        action()

    def watch(self, file: int, action: Action) -> None:
        self.watched[file] = action

    def unwatch(self, file: int) -> None:
        self.watched.pop(file, None)

    def stop(self) -> None:
        self.stopped = True

    @property
    def alarms(self) -> list[Timer]:
        """The timers without a period."""
        return [timer for timer in self.timers if timer.period is None]

    def run(self, period: float) -> None:
        """Run the timers that were made with that period, due or not."""
        for made_with, timer in zip(self._periods, self.timers, strict=True):
            if made_with == period:
                timer.action()

    def ring(self, now: float) -> None:
        """Run the alarms that are due by then, as a loop does after each thing it has run."""
        for alarm in self.alarms:
            if alarm.due <= now:
                alarm.reschedule(now)
                alarm.action()

    def live(self, seconds: float) -> None:
        """Let time pass, and run each timer and alarm when it is due, until it is stopped."""
        end = self.clock.time + seconds
        while not self.stopped:
            for timer in list(self.timers):
                if timer.due <= self.clock.time and not self.stopped:
                    timer.reschedule(self.clock.time)
                    timer.action()
            due = min((timer.due for timer in self.timers), default=float("inf"))
            if due > end:
                break
            self.clock.time = max(self.clock.time, due)
        self.clock.time = max(self.clock.time, end)

    def _add(self, timer: Timer) -> Timer:
        self.timers.append(timer)
        self._periods.append(timer.period)
        return timer
