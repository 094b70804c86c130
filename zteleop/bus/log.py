"""What a node says in words, on the bus and to one listener here.

Each subject once a second, and ever more seldom while it goes on; warnings, which others cause, ten a second
in all.
"""

from collections.abc import Callable

from msgspec import Struct

from zteleop.bus import clock
from zteleop.bus.escape import printable
from zteleop.messages import Log

LEVELS = {"debug": Log.DEBUG, "info": Log.INFO, "warn": Log.WARN, "error": Log.ERROR}
_WORDS = {Log.DEBUG: "debug", Log.INFO: "info", Log.WARN: "warning", Log.ERROR: "error"}
_A_SECOND = 10
FORGOTTEN_AFTER, LONGEST_PAUSE = 1.0, 30.0
"""s without reason to speak of a subject, after which it is new; and s between two sentences at the most"""


class Said(Struct):
    """A subject that was spoken of."""

    told: float
    last: float
    """when there was reason to, last"""
    pause: float
    """s from one sentence to the next"""
    held: int = 0
    """how often it was not told since"""


class NodeLog:
    """Bounds how often a node complains; what is held back is counted."""

    def __init__(self, name: str, publish: Callable[[Log], None], show: Callable[[str], None]) -> None:
        self._name = name
        self._publish = publish
        self.show = show
        self._said: dict[str, Said] = {}
        self._held_back = 0
        self._least = Log.INFO

    def tell_from(self, level: str) -> None:
        """Tell from now on only what is of a level of `LEVELS`, or above."""
        self._least = LEVELS[level]

    def debug(self, text: str) -> None:
        self.tell(Log.DEBUG, text, text)

    def info(self, text: str) -> None:
        self.tell(Log.INFO, text, text)

    def warn(self, text: str, subject: str = "") -> None:
        self.tell(Log.WARN, text, subject or text)

    def error(self, text: str, subject: str = "") -> None:
        self.tell(Log.ERROR, text, subject or text)

    def tell(self, level: int, text: str, subject: str) -> None:
        """Tell a sentence, unless its subject, or too much else, was spoken of just now.

        What goes on and on is told ever more seldom, and what was quiet for a second is news again.
        """
        if level < self._least:
            return
        now = clock.now()
        self._said = {name: one for name, one in self._said.items() if now - one.last < FORGOTTEN_AFTER}
        said = self._said.get(subject)
        lately = sum(now - one.told < FORGOTTEN_AFTER for one in self._said.values())
        if said:
            said.last = now
        if said and now - said.told < said.pause:
            said.held += 1
            return
        if not said and level == Log.WARN and lately >= _A_SECOND:
            self._held_back += 1
            return
        text = printable(text[:500])
        if said and said.held:
            text += f" (and {said.held} time{'s'[: said.held - 1]} more since that was told last)"
        if level == Log.WARN and self._held_back:
            text += f" ({self._held_back} other warnings left out)"
            self._held_back = 0
        self._said[subject] = Said(now, now, min(2 * said.pause, LONGEST_PAUSE) if said else FORGOTTEN_AFTER)
        self._publish(Log(clock.stamp(), level, self._name, text, "", "", 0))
        self.show(f"{self._name}: {_WORDS[level]}: {text}")
