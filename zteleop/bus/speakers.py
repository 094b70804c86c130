"""Whether anybody says a topic that a program hears: one that waits in vain is to know."""

from collections.abc import Callable

from zteleop.bus import clock, presence
from zteleop.bus.loop import Loop
from zteleop.bus.names import Name
from zteleop.bus.session import Session
from zteleop.errors import meant

SPEAKERS = 100
"""of one topic that are remembered"""
LOOK_EVERY, LOOKS = 1.0, 2
"""s between two looks, and how many must find nobody: whose link is back within them was not gone"""


class Speakers:
    """Those of one topic; `tell` hears a sentence when there is nobody, and `tell_again` when there is."""

    def __init__(
        self,
        session: Session,
        name: Name,
        tell: Callable[[str], object],
        tell_again: Callable[[str], object],
    ) -> None:
        selector = f"robot/{name.robot}/live/pub/*/*/*/{name.path}"
        self._tokens = presence.Tokens(session, selector, SPEAKERS)
        self._session = session
        self._name = name
        self._tell = tell
        self._tell_again = tell_again
        self._ever = False
        self._missed = 0
        """looks in a row that found nobody"""

    def watch(self, loop: Loop) -> None:
        """Look who is there, in a loop, for as long as that runs."""
        alarm = loop.alarm(lambda: alarm.ring_at(self.look()))
        alarm.ring_at(clock.now() + LOOK_EVERY)

    def _meant(self) -> str:
        """Return the topic that may have been meant, of those that this robot has."""
        robot, everybody = self._name.robot, presence.endpoints(self._session)
        there = {one.topic for one in everybody if (one.robot, one.kind) == (robot, "pub")}
        question = meant(self._name.path, there)
        return f"; {question}" if question else ""

    def look(self) -> float:
        """Look who has come and gone; return when to look again."""
        there = bool(self._tokens.there())
        if there and self._missed >= LOOKS:
            self._tell_again(f"{self._name} is published now")
        self._missed = 0 if there else self._missed + 1
        self._ever |= there
        if self._missed == LOOKS:
            more = " any more" if self._ever else ""
            hint = "" if self._ever else self._meant()
            self._tell(
                f"nobody publishes {self._name}{more}{hint} (zteleop list -v shows what is said, and by whom)"
            )
        return clock.now() + LOOK_EVERY
