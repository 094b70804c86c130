"""A terminal on which nothing that is typed shows, for as long as a `with` lasts."""

import sys
import termios
from collections.abc import Iterator
from contextlib import contextmanager, suppress

ECHO = termios.ECHO | termios.ICANON


@contextmanager
def hushed() -> Iterator[None]:
    """Show nothing of what is typed, and forget it; Ctrl-C counts. Nothing where standard input is none."""
    if not sys.stdin.isatty():
        yield
        return
    found = termios.tcgetattr(sys.stdin)
    termios.tcsetattr(sys.stdin, termios.TCSANOW, [*found[:3], found[3] & ~ECHO, *found[4:]])
    try:
        yield
    finally:
        with suppress(termios.error):  # hung up
            termios.tcsetattr(sys.stdin, termios.TCSAFLUSH, found)
