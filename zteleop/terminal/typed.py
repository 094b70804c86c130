"""What is typed at a terminal, key by key."""

from typing import Protocol

from zteleop.errors import DeviceError
from zteleop.terminal.any_terminal import AnyTerminal
from zteleop.terminal.keys import Key, KeyParser, Report
from zteleop.terminal.releases import Releases


class Tells(Protocol):
    """Whether it is told when a key is let go, and whether whoever tells is still there."""

    how: str
    """by what it is told"""

    @property
    def told(self) -> bool:
        """It is."""

    @property
    def focused(self) -> bool:
        """The keys are this program's; elsewhere a release is lost."""

    @property
    def known(self) -> bool:
        """There is nothing to wait for."""

    def ping(self, now: float) -> None:
        """Ask whoever tells whether he is still there, now and then."""

    def is_silent(self, now: float) -> bool:
        """Say whether he has not answered for too long."""


class Keys(Protocol):
    """Where keys come from: a terminal, perhaps with what else tells of its keys."""

    terminal: AnyTerminal

    @property
    def ended(self) -> bool:
        """The terminal hung up."""

    @property
    def releases(self) -> Tells:
        """Whether releases are told."""

    def fileno(self) -> int | None:
        """Return what turns readable when something happened to a key; None where somebody else says so."""

    def read(self, now: float) -> list[Key]:
        """Return what happened to keys since, without blocking."""

    def went_on(self, now: float) -> bool:
        """Say, once, that the process was stopped and went on: nobody saw which keys were let go."""

    def suspend(self, now: float) -> None:
        """Stop the process, and return when it goes on; a key half received is forgotten."""

    def close(self) -> None:
        """Let go of everything but the terminal."""


class Typed:
    """The keys of one terminal; `now` in s."""

    def __init__(self, terminal: AnyTerminal) -> None:
        self.terminal = terminal
        self.ended = False
        """The terminal hung up."""
        self.releases = Releases(terminal)
        self._parser = KeyParser()
        self._resumed = 0
        self._asked = False

    def fileno(self) -> int:
        """Return what turns readable when a key was pressed."""
        return self.terminal.fileno()

    def close(self) -> None:
        """Let go of nothing: the terminal is its owner's."""

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


def open_terminal() -> AnyTerminal:
    """Return the terminal the program runs in; DeviceError where there is none."""
    try:
        from zteleop.terminal.terminal import Terminal
    except ImportError as error:
        raise DeviceError(
            f"expected a terminal with Unix modes, found a Python without {error.name}; "
            "run it on Linux, macOS or in WSL"
        ) from None
    return Terminal()
