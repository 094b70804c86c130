import os
import pty
import select
import signal
import subprocess
import sys
import termios
from collections.abc import Iterator

import pytest

from zteleop.machine.guardian import guarded

WORDS = "\x1b[?1049lback\n"
PROGRAM = """
import sys, termios
from zteleop.machine.guardian import guarded

terminal, words, ending = sys.argv[1:]
with guarded(terminal, words):
    with open(terminal, "r+b", buffering=0) as tty:
        modes = termios.tcgetattr(tty)
        modes[3] &= ~(termios.ICANON | termios.ECHO | termios.ISIG)
        termios.tcsetattr(tty, termios.TCSANOW, modes)
    print("taken", flush=True)
    sys.stdin.readline()
"""


class Desk:
    """A terminal, and a program that takes it."""

    def __init__(self, program: str = PROGRAM) -> None:
        self.master, self.slave = pty.openpty()
        self.found = termios.tcgetattr(self.slave)
        command = [sys.executable, "-c", program, os.ttyname(self.slave), WORDS, ""]
        self.program = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        assert self.program.stdout
        assert self.program.stdout.readline() == b"taken\n"

    def said(self) -> str:
        """What was written to the terminal, once something was."""
        assert select.select([self.master], [], [], 30.0)[0]
        return os.read(self.master, 1000).decode().replace("\r", "")

    def close(self) -> None:
        with self.program:
            self.program.kill()
        os.close(self.master)
        os.close(self.slave)


@pytest.fixture
def desk() -> Iterator[Desk]:
    desk = Desk()
    yield desk
    desk.close()


def test_whoever_is_killed_leaves_the_terminal_as_it_was_found(desk: Desk) -> None:
    assert termios.tcgetattr(desk.slave) != desk.found
    desk.program.send_signal(signal.SIGKILL)
    assert desk.said() == WORDS
    assert termios.tcgetattr(desk.slave) == desk.found


def test_modes_that_a_shell_has_set_meanwhile_stay(desk: Desk) -> None:
    theirs = termios.tcgetattr(desk.slave)
    theirs[3] |= termios.ISIG
    termios.tcsetattr(desk.slave, termios.TCSANOW, theirs)
    desk.program.send_signal(signal.SIGKILL)
    assert desk.said() == WORDS
    assert termios.tcgetattr(desk.slave) == theirs


def test_whoever_ends_by_himself_has_said_farewell(desk: Desk) -> None:
    desk.program.communicate(b"\n", timeout=30)
    assert desk.program.returncode == 0
    assert not select.select([desk.master], [], [], 0)[0], "the guardian has ended before"


@pytest.mark.parametrize("terminal", ["/dev/null", "/nowhere/tty"])
def test_what_is_no_terminal_is_guarded_by_nobody(terminal: str) -> None:
    with guarded(terminal, WORDS):
        pass


def test_without_a_shell_nobody_guards(monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(*arguments: object, **options: object) -> None:
        raise FileNotFoundError("/bin/sh")

    monkeypatch.setattr(subprocess, "Popen", missing)
    with guarded("/dev/null", WORDS):
        pass
