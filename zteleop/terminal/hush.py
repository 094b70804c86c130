"""A terminal on which nothing that is typed shows, for as long as a `with` lasts."""

import termios
from collections.abc import Iterator
from contextlib import contextmanager, suppress

from zteleop.errors import DeviceError
from zteleop.terminal.terminal import find_terminal

ECHO = termios.ECHO | termios.ICANON


@contextmanager
def hushed() -> Iterator[None]:
    """Show nothing of what is typed, and forget it; Ctrl-C counts. Nothing where there is no terminal."""
    try:
        terminal = find_terminal()
    except DeviceError:
        yield
        return
    found = termios.tcgetattr(terminal)
    termios.tcsetattr(terminal, termios.TCSANOW, [*found[:3], found[3] & ~ECHO, *found[4:]])
    try:
        yield
    finally:
        with suppress(termios.error):  # hung up
            termios.tcsetattr(terminal, termios.TCSAFLUSH, found)
