"""One thread that waits for inboxes, timers and files, and runs what belongs to them."""

import select
import socket
import threading
from collections import deque
from collections.abc import Callable

from msgspec import Struct

from zteleop.bus import clock

Action = Callable[[], object]


class Timer(Struct):
    """Fires on an absolute schedule; what was missed is not made up for."""

    period: float
    action: Action
    due: float


class Loop:
    """Runs actions one after another in the thread that calls `run`."""

    def __init__(self, before_each: Action) -> None:
        self.before_each = before_each
        self._ready: deque[Action] = deque()
        self._timers: list[Timer] = []
        self._files: dict[int, Action] = {}
        self._ear, self._bell = socket.socketpair()
        self._ear.setblocking(False)
        self._bell.setblocking(False)
        self._rung = threading.Lock()
        self._running = True

    def close(self) -> None:
        self._ear.close()
        self._bell.close()

    def stop(self) -> None:
        """End `run` after the action at hand; safe from any thread."""
        self._running = False
        self._ring()

    def call_soon(self, action: Action) -> None:
        """Run an action in the loop's thread; safe from any thread."""
        self._ready.append(action)
        self._ring()

    def every(self, period: float, action: Action) -> Timer:
        """Run an action every `period` seconds, the first time at once."""
        timer = Timer(period, action, clock.now())
        self._timers.append(timer)
        return timer

    def watch(self, file: int, action: Action) -> None:
        """Run an action whenever a file can be read."""
        self._files[file] = action

    def unwatch(self, file: int) -> None:
        self._files.pop(file, None)

    def run(self, until: float | None = None) -> None:
        """Run actions until `stop`, or until a time of the bus clock."""
        while self._running and (until is None or clock.now() < until):
            self.run_once(until)

    def run_once(self, until: float | None = None) -> None:
        """Wait for the next thing to do, and do what is due."""
        dues = [timer.due for timer in self._timers]
        due = min([*dues, until] if until is not None else dues, default=None)
        timeout = None if due is None else max(0.0, due - clock.now())
        readable = select.select([self._ear.fileno(), *self._files], [], [], 0 if self._ready else timeout)[0]
        if self._ear.fileno() in readable:
            self._answer()
        for _ in range(len(self._ready)):
            self._run(self._ready.popleft())
        for file in readable:
            if file in self._files:
                self._run(self._files[file])
        self._run_timers()

    def _run_timers(self) -> None:
        for timer in self._timers:
            late = clock.now() - timer.due
            if late >= 0:
                timer.due += timer.period * (1 + late // timer.period)
                self._run(timer.action)

    def _run(self, action: Action) -> None:
        if self._running:
            self.before_each()
            action()

    def _ring(self) -> None:
        if self._rung.acquire(blocking=False):
            self._bell.send(b"!")

    def _answer(self) -> None:
        self._ear.recv(16)
        self._rung.release()
