"""The questions of `zteleop calibrate` on pages: one sits before each part of them, whoever presses.

A press counts when its page has just been told how the robot stands: it gives the robot's time back with it,
and one that comes late was meant for another moment.
"""

from collections.abc import Callable
from functools import partial
from queue import Empty, SimpleQueue
from threading import Lock
from typing import NamedTuple

from zteleop.bridges.web.slots import Slots
from zteleop.bridges.web.words import Asks, Hello, Note, Press, Said, Told, text
from zteleop.bus.node import Node

BEGIN, SEEN, AWAY = "begin", "seen", ""
"""what a page presses to let it begin, and once the last word is shown; the last page is closed"""
LATE = 1.0
"""s of the robot's time between what a page was told and its press"""
ENDS = ("backspace", "q")
STOPS = (*ENDS, "space")
"""keys that count however late: they only bring rest"""

STARTS, AGAIN = Told(["the robot is started"]), Told(["the robot is started anew"])


class Sitting(NamedTuple):
    """Somebody before one part of the questions."""

    node: Node
    press: Callable[[str], object]
    """called in the node's loop"""

    @property
    def time(self) -> float:
        """The robot's newest, as far as it is heard."""
        beat = self.node.membership.heard().beat
        return beat.time if beat else 0.0


class Questions:
    """What is behind a server; `join`, `leave` and `hear` are called in its thread."""

    def __init__(self, robot: str, version: str) -> None:
        self._robot = robot
        self._version = version
        self._lock = Lock()
        self._pages: dict[str, Slots] = {}
        self._word: Asks | Told = STARTS
        self._sitting: Sitting | None = None
        self._kept: set[str] = set()
        """what ends it, pressed while the robot started"""
        self._pressed: SimpleQueue[str] = SimpleQueue()
        """where no question is asked"""

    def join(self, page: str, slots: Slots) -> None:
        """Let a page in: any may answer."""
        slots.put("hello", text(Hello(self._robot, self._version, page)))
        with self._lock:
            self._pages[page] = slots
            slots.put("word", text(self._word))

    def leave(self, page: str) -> None:
        """Forget a page."""
        with self._lock:
            self._pages.pop(page, None)
            if not self._pages:
                self._pressed.put(AWAY)

    def hear(self, page: str, said: Said) -> None:
        """Take in a press; nothing else is said here."""
        if not isinstance(said, Press):
            return
        sitting = self._sitting
        if sitting is None:
            self._pressed.put(said.key)
            self._kept.update({said.key} & {*ENDS})
        elif said.key not in STOPS and sitting.time - said.beat > LATE:
            self._pages[page].put(
                "note", text(Note("that press came late, and counts for nothing: press again"))
            )
        else:
            sitting.node.membership.loop.call_soon(partial(sitting.press, said.key))

    def sit(self, sitting: Sitting | None) -> None:
        """Let somebody answer, or nobody while no question is asked: a stop is kept for the next."""
        self._sitting = sitting
        if sitting is None:
            self.tell(AGAIN)
            return
        for key in self._kept:
            sitting.node.membership.loop.call_soon(partial(sitting.press, key))
        self._kept.clear()

    def tell(self, word: Asks | Told) -> None:
        """Tell all pages what is so now."""
        frame = text(word)
        with self._lock:
            self._word = word
            for slots in self._pages.values():
                slots.put("word", frame)

    def await_begin(self, lines: list[str], begins: str) -> None:
        """Wait until somebody has pressed what begins it, having read these lines."""
        self.tell(Told(lines, begins))
        while self._pressed.get() != BEGIN:
            pass
        self._kept.clear()
        self.tell(STARTS)

    def end(self, lines: list[str], within: float) -> None:
        """Tell the last word, and wait, not for long, until a page has shown it, or all are closed."""
        while not self._pressed.empty():
            self._pressed.get()
        self.tell(Told(lines, ends=True))
        try:
            while self._pages and self._pressed.get(timeout=within) not in (SEEN, AWAY):
                pass
        except Empty:
            pass
