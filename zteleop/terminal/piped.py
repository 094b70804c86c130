"""What stands in a terminal's place where keys come from a pipe: it has one line instead of a screen."""

import os
import sys
from collections.abc import Sequence
from typing import Self

SIZE = (200, 1)
"""columns and rows: everything that matters, in one line"""


class PipedTerminal:
    """Reads keys from a file, by default standard input, until it ends."""

    def __init__(self, fd: int | None = None) -> None:
        self.name = ""
        self.farewell = ""
        self.color = False
        self.unicode = False
        self.resumed = 0
        self._fd = sys.stdin.fileno() if fd is None else fd
        self._line = ""

    def __enter__(self) -> Self:
        os.set_blocking(self._fd, False)
        return self

    def __exit__(self, *exc: object) -> None:
        os.set_blocking(self._fd, True)
        if self._line and exc[0] is None:
            self.draw(["ended: the last word is neutral"])

    def fileno(self) -> int:
        """Return what turns readable when a key has come, or the last of them."""
        return self._fd

    def read(self) -> bytes:
        """Return what has come, b"" for nothing; EOFError when no more comes."""
        try:
            data = os.read(self._fd, 4096)
        except BlockingIOError:
            return b""
        if not data:
            raise EOFError("the input has ended")
        return data

    def draw(self, lines: Sequence[str]) -> None:
        """Print the first line, where it is another than before."""
        line = lines[0] if lines else ""
        if line != self._line:
            self._line = line
            sys.stdout.write(f"{line}\n")
            sys.stdout.flush()

    def redraw(self) -> None:
        """Print it again at the next draw."""
        self._line = ""

    def say(self, text: str) -> bool:
        """Say that nothing would answer."""
        return False

    def switch_on(self, on: str, off: str) -> bool:
        """Say that there is nothing to switch."""
        return False

    def suspend(self) -> None:
        """Do nothing: a pipe has no shell to go back to."""

    def size(self) -> tuple[int, int]:
        return SIZE
