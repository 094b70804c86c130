"""Whether a terminal tells when a key is let go, and whether it is still there to tell.

It is asked for kitty's keyboard protocol, and for its attributes, which every terminal answers: so nobody
waits in vain for the answer of one that does not know the first.
"""

from zteleop.terminal.any_terminal import AnyTerminal
from zteleop.terminal.keys import Report

ASK = "\x1b[?u\x1b[c"
ON, OFF = "\x1b[>15u\x1b[?1004h", "\x1b[?1004l\x1b[<u"
"""Every key as a sequence with its event and its place (1 + 2 + 4 + 8), and reports of the focus."""
TELLS_EVENTS = 2
PING = "\x1b[c"
PING_EVERY = 0.1
"""s"""
SILENT = 0.4
"""s without a byte, although asked, after which a terminal is gone: a release may be lost with it."""


class Releases:
    """Asks one terminal; `now` in s."""

    def __init__(self, terminal: AnyTerminal) -> None:
        self.how = "kitty protocol"
        """By what it is told."""
        self._terminal = terminal
        self.told = False
        """It tells when a key is let go."""
        self.focused = True
        self._unanswered = 0
        self._heard = float("-inf")
        self._asked = float("-inf")

    @property
    def known(self) -> bool:
        """Whether the terminal has answered what it was asked so far."""
        return not self._unanswered

    def ask(self, now: float) -> None:
        """Ask anew, as after the terminal was somebody else's; until the answer nothing is told."""
        self.told, self.focused = False, True
        self._say(ASK, now)

    def ping(self, now: float) -> None:
        """Ask a terminal that tells releases whether it is still there, now and then."""
        if self.told and now - self._asked >= PING_EVERY:
            self._say(PING, now)

    def is_silent(self, now: float) -> bool:
        """Say whether a terminal that was asked again and again has said nothing."""
        return self.told and now - self._heard > SILENT

    def hear_bytes(self, now: float) -> None:
        """Note that the terminal is there."""
        self._heard = now

    def hear(self, report: Report, now: float) -> None:
        """Take in an answer."""
        if report.of == "focus":
            self.focused = bool(report.value)
        elif report.of == "attributes":
            self._unanswered = max(0, self._unanswered - 1)
        else:
            self.told = bool(report.value & TELLS_EVENTS)
            if not self.told and self._terminal.switch_on(ON, OFF):
                self._say(ASK, now)  # some grant less than they are asked for

    def _say(self, text: str, now: float) -> None:
        self._unanswered += self._terminal.say(text)
        self._asked = now
