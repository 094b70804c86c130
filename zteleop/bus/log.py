"""What a node says in words, on the bus and to one listener here.

Each subject once a second; warnings, which others cause, ten a second in all.
"""

from collections.abc import Callable

from zteleop.bus import clock
from zteleop.bus.escape import printable
from zteleop.messages import Log

LEVELS = {"debug": Log.DEBUG, "info": Log.INFO, "warn": Log.WARN, "error": Log.ERROR}
_WORDS = {Log.DEBUG: "debug", Log.INFO: "info", Log.WARN: "warning", Log.ERROR: "error"}
_A_SECOND = 10


class NodeLog:
    """Bounds how often a node complains; what is held back is counted."""

    def __init__(self, name: str, publish: Callable[[Log], None], show: Callable[[str], None]) -> None:
        self._name = name
        self._publish = publish
        self.show = show
        self._said: dict[str, float] = {}
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
        """Tell a sentence, unless its subject, or too much else, was spoken of within the last second."""
        if level < self._least:
            return
        now = clock.now()
        self._said = {said: at for said, at in self._said.items() if now - at < 1.0}
        if subject in self._said or (level == Log.WARN and len(self._said) >= _A_SECOND):
            self._held_back += 1
            return
        self._said[subject] = now
        text = printable(text[:500]) + (f" ({self._held_back} more left out)" if self._held_back else "")
        self._held_back = 0
        self._publish(Log(clock.stamp(), level, self._name, text, "", "", 0))
        self.show(f"{self._name}: {_WORDS[level]}: {text}")
