"""The black box: the last minute of every topic, written when the robot stopped for a reason.

A process of its own that outlives the actuator and its watchdog, and that both can do without.
"""

import os
import select
import threading
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path

from zteleop.bus import clock
from zteleop.bus.node import Node
from zteleop.bus.tap import Tap
from zteleop.machine import signals
from zteleop.machine.sidecar import LAST_WORD
from zteleop.recording import blackbox_file
from zteleop.recording.blackbox_file import FORMAT, Header, Reason, seconds
from zteleop.recording.ring import Ring, Snapshot
from zteleop.recording.triggers import WATCHDOG, Trigger, Triggers

LISTENS_WITHIN, TEND_EVERY = 0.1, 0.5
"""s that what arrives may wait, as the door takes note when it does, and s between looks for what is due"""
AFTERMATH = 1.0
"""s that are kept of what follows a trigger"""
PAUSE = 10.0
"""s from one file to the next; a trigger in between waits"""
FLUSH = 5.0
"""s for the disk when the process ends"""


class Writer:
    """Writes files in a thread: a disk may hang, and pressing 24 MB takes a second."""

    def __init__(self, robot: str, folder: Path) -> None:
        self._robot = robot
        self._folder = folder
        self._thread: threading.Thread | None = None
        self.trouble = ""
        """what the disk last refused, in words"""

    @property
    def busy(self) -> bool:
        return self._thread is not None and self._thread.is_alive()

    def write(self, held: Snapshot, triggers: list[Trigger]) -> None:
        """Begin to write what a ring held, for the first of some reasons."""
        if self.busy:  # at the end of the process, for an older reason
            return
        now, wall = clock.now(), time.time()  # together: they relate all other times
        self._thread = threading.Thread(target=self._run, args=(held, triggers, wall - now), daemon=True)
        signals.start(self._thread)

    def finish(self) -> None:
        """Wait for the disk, but not for ever."""
        if self._thread:
            self._thread.join(FLUSH)

    def _run(self, held: Snapshot, triggers: list[Trigger], offset: float) -> None:
        try:
            blackbox_file.write(self._folder, self._header(held, triggers, offset), held.messages)
        except (OSError, MemoryError) as error:
            self.trouble = getattr(error, "strerror", None) or type(error).__name__

    def _header(self, held: Snapshot, triggers: list[Trigger], offset: float) -> Header:
        first, messages = triggers[0], held.messages
        return Header(
            blackbox=FORMAT,
            robot=self._robot,
            version=version("zteleop"),
            at=seconds(first.at),
            time=blackbox_file.utc(first.at + offset),
            reason=first.reason,
            why=first.why,
            span=round(messages[-1].at - messages[0].at, 1) if messages else 0.0,
            topics=held.topics,
            triggers=[Reason(seconds(at), reason, why) for at, reason, why in triggers],
            floods=held.floods,
            elsewhere=held.elsewhere,
        )


class BlackBox:
    """Listens until the watchdog ends; `ear` is the pipe that ends with it."""

    def __init__(
        self, node: Node, tap: Tap, ring: Ring, writer: Writer, ear: int, warn: Callable[[str], object]
    ) -> None:
        self._node = node
        self._tap = tap
        self._ring = ring
        self._writer = writer
        self._ear = ear
        self._triggers = Triggers()
        self._waiting: list[Trigger] = []
        self._due = float("inf")
        self._written = float("-inf")
        self._warn = warn
        self._warned = False
        self._parted = False

    def run(self) -> None:
        """Listen until told to end, or until the watchdog is gone; write first what is due."""
        self._node.membership.loop.watch(self._ear, self._hear_watchdog)
        loop = self._node.membership.loop
        self._node.membership.session.attend(self._listen, loop, LISTENS_WITHIN)
        self._node.every(TEND_EVERY)(self._listen)
        try:
            self._node.spin()
        finally:
            self._finish()

    def _listen(self) -> None:
        for raw in self._tap.take():
            self._ring.add(raw)
            if trigger := self._triggers.hear(raw):
                self._note(trigger)
        if self._due <= clock.now() and not self._writer.busy:
            self._write()
        self._complain()

    def _note(self, trigger: Trigger) -> None:
        if not self._waiting:
            self._due = max(trigger.at + AFTERMATH, self._written + PAUSE)
        self._waiting.append(trigger)
        del self._waiting[100:]

    def _write(self) -> None:
        self._writer.write(self._ring.snapshot(), self._waiting)
        self._waiting, self._due, self._written = [], float("inf"), clock.now()

    def _complain(self) -> None:
        if self._writer.trouble and not self._warned:
            self._warned = True
            self._warn(f"the black box cannot be kept: {self._writer.trouble}")

    def _hear_watchdog(self) -> None:
        """Take its last word, or its end without one."""
        word = os.read(self._ear, len(LAST_WORD))
        if not word and not self._parted:
            self._note(Trigger(clock.now(), WATCHDOG, "it said no farewell"))
        self._parted = True
        self._node.stop()

    def _finish(self) -> None:
        """Write what is due; a signal to end may have come because the watchdog is gone."""
        if not self._parted and select.select([self._ear], [], [], 0)[0]:
            self._hear_watchdog()
        self._listen()
        if self._waiting:
            self._writer.finish()
            self._write()
        self._writer.finish()
        self._complain()
