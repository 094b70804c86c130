"""What a node says in words: on the bus and to one listener here, each subject at most once a second."""

from collections.abc import Callable

from zteleop.bus import clock
from zteleop.messages import Log

_LEVELS = {Log.DEBUG: "debug", Log.INFO: "info", Log.WARN: "warning", Log.ERROR: "error"}
_SUBJECTS = 100


class NodeLog:
    """Bounds how often a node complains; what is held back is counted."""

    def __init__(self, name: str, publish: Callable[[Log], None], show: Callable[[str], None]) -> None:
        self._name, self._publish, self.show = name, publish, show
        self._said: dict[str, float] = {}
        self._held_back: dict[str, int] = {}

    def info(self, text: str) -> None:
        self.say(Log.INFO, text, text)

    def warn(self, text: str, subject: str = "") -> None:
        self.say(Log.WARN, text, subject or text)

    def error(self, text: str, subject: str = "") -> None:
        self.say(Log.ERROR, text, subject or text)

    def say(self, level: int, text: str, subject: str) -> None:
        """Say a sentence, unless its subject was spoken of within the last second."""
        now = clock.now()
        if now - self._said.get(subject, float("-inf")) < 1.0:
            self._held_back[subject] = self._held_back.get(subject, 0) + 1
            return
        if len(self._said) >= _SUBJECTS:
            self._said.clear()
            self._held_back.clear()
        self._said[subject] = now
        more = self._held_back.pop(subject, 0)
        text = text[:500] + (f" ({more} more like it)" if more else "")
        self._publish(Log(clock.stamp(), level, self._name, text, "", "", 0))
        self.show(f"{self._name}: {_LEVELS[level]}: {text}")
