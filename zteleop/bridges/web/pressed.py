"""Keys that are pressed on a page, for an input that otherwise has a terminal."""

from collections.abc import Sequence
from typing import Self

from zteleop.terminal.any_terminal import AnyTerminal
from zteleop.terminal.keys import Key


class Nowhere:
    """The terminal of a page: nothing is typed there, and nothing is shown."""

    name = ""
    color = unicode = False
    resumed = 0
    farewell = ""

    def fileno(self) -> int:
        """Return no file: a page's keys come by another thread."""
        return -1

    def read(self) -> bytes:
        return b""

    def draw(self, lines: Sequence[str]) -> None:
        """Show nothing."""

    def redraw(self) -> None:
        """Show nothing anew."""

    def say(self, text: str) -> bool:
        return False

    def switch_on(self, on: str, off: str) -> bool:
        return False

    def suspend(self) -> None:
        """Have no key that asks for it."""

    def size(self) -> tuple[int, int]:
        return 80, 24

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *exc: object) -> None:
        """Give nothing back."""


class Clicks:
    """A button that is clicked is let go as well: each press is one, and a browser says no repeats."""

    how = "a page"
    told = focused = known = True

    def ping(self, now: float) -> None:
        """Ask nobody."""

    def is_silent(self, now: float) -> bool:
        return False


class Pressed:
    """Filled by `press`, in the loop in which they are read."""

    def __init__(self) -> None:
        self.terminal: AnyTerminal = Nowhere()
        self.releases = Clicks()
        self.ended = False
        """Nobody is there any more who could press."""
        self._waiting: list[Key] = []

    def press(self, name: str) -> None:
        """Take in that a key was pressed."""
        self._waiting.append(Key(name))

    def fileno(self) -> None:
        """Return None: whoever presses says so."""

    def read(self, now: float) -> list[Key]:
        """Return what was pressed since."""
        keys, self._waiting = self._waiting, []
        return keys

    def went_on(self, now: float) -> bool:
        return False

    def suspend(self, now: float) -> None:
        """Have no key that asks for it."""

    def close(self) -> None:
        """Forget what was pressed."""
        self._waiting.clear()
