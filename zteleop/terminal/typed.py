"""What is typed at a terminal, key by key."""

from typing import TYPE_CHECKING

from zteleop.errors import DeviceError
from zteleop.terminal.keys import Key, KeyParser, Report
from zteleop.terminal.releases import Releases

if TYPE_CHECKING:
    from zteleop.terminal.terminal import Terminal


class Typed:
    """The keys of one terminal; `now` in s."""

    def __init__(self, terminal: "Terminal") -> None:
        self.terminal = terminal
        self.ended = False
        """The terminal hung up."""
        self.releases = Releases(terminal)
        self._parser = KeyParser()
        self._resumed = 0
        self._asked = False

    def read(self, now: float) -> list[Key]:
        """Return what happened to keys since, without blocking."""
        if not self._asked:
            self._asked = True
            self.releases.ask(now)
        found = self._parser.flush(now)
        try:
            if data := self.terminal.read():
                self.releases.hear_bytes(now)
                found += self._parser.feed(data, now)
        except EOFError:
            self.ended = True
        keys = []
        for one in found:
            if isinstance(one, Report):
                self.releases.hear(one, now)
            else:
                keys.append(one)
        return keys

    def went_on(self, now: float) -> bool:
        """Say, once, that the process was stopped and went on: nobody saw which keys were let go."""
        if self._resumed == self.terminal.resumed:
            return False
        self._resumed = self.terminal.resumed
        self.releases.ask(now)
        return True

    def suspend(self, now: float) -> None:
        """Stop the process, and return when it goes on; a key half received is forgotten."""
        self.terminal.suspend()
        self._resumed = self.terminal.resumed
        self._parser = KeyParser()
        self.releases.ask(now)


def open_terminal() -> "Terminal":
    """Return the terminal the program runs in; DeviceError where there is none."""
    try:
        from zteleop.terminal.terminal import Terminal
    except ImportError as error:
        raise DeviceError(
            f"expected a terminal with Unix modes, found a Python without {error.name}; "
            "run it on Linux, macOS or in WSL"
        ) from None
    return Terminal()
