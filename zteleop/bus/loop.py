"""One thread that waits for inboxes, timers and files, and runs what belongs to them."""

import os
import select
import signal
import threading
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from msgspec import Struct

from zteleop.bus import clock
from zteleop.control.proof import NEVER

Action = Callable[[], object]
FAR = float("inf")
LONGEST_WAIT = 60.0
OVERSLEPT = 0.5
"""s after its time at which a loop wakes, or ends an action, that stood still: suspended, or in a sleep"""
ROUNDING = 1e-6
"""s, of which the next time of a schedule may lie ahead only because times are no whole numbers"""
RING = b"!"
"""a byte that is no signal's number"""


class Timer(Struct):
    """Fires on an absolute schedule, or once where there is no period; what was missed is not made up for."""

    period: float | None
    action: Action
    due: float
    origin: float = 0.0
    """A moment of its schedule, which it keeps at any pace: timers made together fire together."""

    def ring_at(self, due: float) -> None:
        """Fire at a time of the bus clock."""
        self.due = due

    def pace(self, period: float, now: float) -> None:
        """Fire at another period from now on, the next time within one of it."""
        if period != self.period:
            self.period = period
            self.due = min(self.due, self._next(period, now))

    def reschedule(self, now: float) -> None:
        """Take the next time of the schedule that lies ahead."""
        if self.period is None:
            self.due = FAR
        else:
            self.due = self._next(self.period, now)

    def _next(self, period: float, now: float) -> float:
        ahead = self.origin + period * (1 + (now - self.origin) // period)
        return ahead if ahead > now + ROUNDING else ahead + period


class Loop:
    """Runs actions one after another in the thread that calls `run`."""

    def __init__(self, before_each: Action) -> None:
        self.before_each = before_each
        self._ready: deque[Action] = deque()
        self._timers: list[Timer] = []
        self._files: dict[int, Action] = {}
        self._ear, self._bell = os.pipe()
        os.set_blocking(self._bell, False)
        self._rung = threading.Lock()
        self._running = True
        self._woke = clock.now()
        self.awake_since = NEVER
        """When it last woke from standing still, by the bus clock."""

    def close(self) -> None:
        if self._bell < 0:
            return
        bell, self._bell = self._bell, -1
        os.close(bell)
        os.close(self._ear)

    def stop(self) -> None:
        """End the present run after the action at hand, or the next; safe from any thread."""
        self._running = False
        self._ring()

    def call_soon(self, action: Action) -> None:
        """Run an action in the loop's thread; safe from any thread."""
        self._ready.append(action)
        self._ring()

    def fail(self, error: BaseException) -> None:
        """Raise an error out of the present run, or the next; safe from any thread."""

        def throw() -> None:
            raise error

        self.call_soon(throw)

    def call_next(self, action: Action) -> None:
        """Run an action in the next round; for the loop's own thread, which nobody need wake."""
        self._ready.append(action)

    def every(self, period: float, action: Action) -> Timer:
        """Run an action every `period` seconds, the first time at once."""
        now = clock.now()
        timer = Timer(period, action, now, now)
        self._timers.append(timer)
        return timer

    def alarm(self, action: Action) -> Timer:
        """Return a timer that runs an action once, whenever it is told when."""
        timer = Timer(None, action, FAR)
        self._timers.append(timer)
        return timer

    def watch(self, file: int, action: Action) -> None:
        """Run an action whenever a file can be read."""
        self._files[file] = action

    def unwatch(self, file: int) -> None:
        self._files.pop(file, None)

    def run(self, until: float | None = None) -> None:
        """Run actions until `stop`, or until a time of the bus clock; what is ready is done even then."""
        self._woke = clock.now()  # before this run whoever calls it may have paused on purpose
        with self._woken_by_signals():
            try:
                while self._running:
                    self.run_once(until)
                    if until is not None and clock.now() >= until:
                        return
            finally:
                self._running = True

    @contextmanager
    def _woken_by_signals(self) -> Iterator[None]:
        """Let a signal end the wait for the next thing to do, also one that comes just before it begins.

        Else it is heard at the next timer, which may be a minute away: Ctrl-C in vain. Only Python's main
        thread handles signals.
        """
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        before = signal.set_wakeup_fd(self._bell, warn_on_full_buffer=False)
        try:
            yield
        finally:
            signal.set_wakeup_fd(before, warn_on_full_buffer=False)

    def run_once(self, until: float | None = None) -> None:
        """Wait for the next thing to do, and do what is due."""
        due = min((timer.due for timer in self._timers), default=FAR)
        due = min(due, FAR if until is None else until)
        self._stir()
        timeout = 0.0 if self._ready else max(0.0, min(due - self._woke, LONGEST_WAIT))
        readable = select.select([self._ear, *self._files], [], [], timeout)[0]
        self._stir(timeout)
        if self._ear in readable:
            self._answer()
        for file in readable:  # first: what they bring need not wait for another round
            if file in self._files:
                self._run(self._files[file])
        for _ in range(len(self._ready)):
            if self._running:  # else the next run does it
                self._run(self._ready.popleft())
        self._run_timers()

    def _run_timers(self) -> None:
        for timer in self._timers:
            now = clock.now()
            if timer.due <= now:
                timer.reschedule(now)
                self._run(timer.action)

    def _run(self, action: Action) -> None:
        if self._running:
            self._stir()
            self.before_each()
            action()

    def _stir(self, slept: float = 0.0) -> None:
        """Notice whether more time has passed than the loop slept on purpose."""
        now = clock.now()
        if now - self._woke - slept > OVERSLEPT:
            self.awake_since = now
        self._woke = now

    def _ring(self) -> None:
        if self._bell >= 0 and self._rung.acquire(blocking=False):
            os.write(self._bell, RING)

    def _answer(self) -> None:
        if RING in os.read(self._ear, 64):  # besides it the numbers of signals
            self._rung.release()
