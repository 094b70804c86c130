"""What every terminal can do for whoever reads keys from it and shows lines on it."""

from collections.abc import Sequence
from typing import Protocol, Self


class AnyTerminal(Protocol):
    """Keys in, frames out, used in a `with`."""

    name: str
    """of its device; empty where it has none"""
    color: bool
    unicode: bool
    resumed: int
    """How often the process was stopped and went on."""

    @property
    def farewell(self) -> str:
        """What gives it back when anything may have been changed."""

    def fileno(self) -> int:
        """Return what turns readable when something was typed."""

    def read(self) -> bytes:
        """Return what was typed, b"" for nothing; EOFError when no more can come."""

    def draw(self, lines: Sequence[str]) -> None:
        """Show these lines."""

    def redraw(self) -> None:
        """Show every line anew at the next draw."""

    def say(self, text: str) -> bool:
        """Write a question or a command; False where nothing would answer."""

    def switch_on(self, on: str, off: str) -> bool:
        """Write what changes a mode, and at the end what changes it back; False when it was on already."""

    def suspend(self) -> None:
        """Give it back and stop, as Ctrl-Z does; go on where the shell says so."""

    def size(self) -> tuple[int, int]:
        """Return columns and rows."""

    def __enter__(self) -> Self: ...
    def __exit__(self, *exc: object) -> None: ...
