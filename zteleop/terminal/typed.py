"""What is typed at a terminal, as names of keys."""

from typing import TYPE_CHECKING

from zteleop.terminal.keys import KeyParser

if TYPE_CHECKING:
    from zteleop.terminal.terminal import Terminal


class Typed:
    """The keys of one terminal; `now` in s."""

    def __init__(self, terminal: "Terminal") -> None:
        self.terminal = terminal
        self.ended = False
        """The terminal hung up."""
        self._parser = KeyParser()
        self._resumed = 0

    def read(self, now: float) -> list[str]:
        """Return the keys pressed since, without blocking."""
        keys = self._parser.flush(now)
        try:
            return keys + self._parser.feed(self.terminal.read(), now)
        except EOFError:
            self.ended = True
            return keys

    def went_on(self) -> bool:
        """Say, once, that the process was stopped and went on: nobody saw which keys were let go."""
        before = self._resumed
        self._resumed = self.terminal.resumed
        return self._resumed != before

    def suspend(self) -> None:
        """Stop the process, and return when it goes on; a key half received is forgotten."""
        self.terminal.suspend()
        self._resumed = self.terminal.resumed
        self._parser = KeyParser()
