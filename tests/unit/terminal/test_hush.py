import io
import os
import pty
import select
import sys
import termios
from collections.abc import Iterator

import pytest

from zteleop.terminal.hush import ECHO, hushed


@pytest.fixture
def typing(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """Standard input is a terminal, at which somebody types into this file."""
    master, slave = pty.openpty()
    with os.fdopen(slave) as stdin:
        monkeypatch.setattr(sys, "stdin", stdin)
        yield master
    os.close(master)


def local_modes() -> int:
    return termios.tcgetattr(sys.stdin)[3]


def test_what_is_typed_meanwhile_neither_shows_nor_reaches_the_shell(typing: int) -> None:
    before = termios.tcgetattr(sys.stdin)
    with hushed():
        assert not local_modes() & ECHO
        assert local_modes() & termios.ISIG, "Ctrl-C counts"
        os.write(typing, b"rm -rf\n")
        assert select.select([sys.stdin], [], [], 5.0)[0], "it has arrived"
    assert termios.tcgetattr(sys.stdin) == before
    os.set_blocking(typing, False)
    with pytest.raises(BlockingIOError):
        os.read(typing, 100)
    os.set_blocking(sys.stdin.fileno(), False)
    with pytest.raises(BlockingIOError):
        os.read(sys.stdin.fileno(), 100)


def test_an_error_gives_the_terminal_back_as_well(typing: int) -> None:
    before = termios.tcgetattr(sys.stdin)
    with pytest.raises(KeyboardInterrupt), hushed():
        raise KeyboardInterrupt
    assert termios.tcgetattr(sys.stdin) == before


def test_what_is_no_terminal_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    with hushed():
        pass


def test_a_terminal_on_which_something_is_only_shown_is_hushed_as_well(
    typing: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown = sys.stdin
    monkeypatch.setattr(sys, "stdin", None)
    monkeypatch.setattr(sys, "stdout", shown)
    with hushed():
        assert not termios.tcgetattr(shown)[3] & ECHO
