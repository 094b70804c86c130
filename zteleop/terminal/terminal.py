"""A terminal in raw mode for as long as a `with` lasts, left exactly as it was found."""

import errno
import os
import select
import signal
import sys
import termios
from collections.abc import Sequence
from contextlib import suppress
from types import FrameType
from typing import Any, Self

from zteleop.errors import DeviceError
from zteleop.terminal.capabilities import speaks_unicode, wants_color
from zteleop.terminal.frames import changes, one_line
from zteleop.terminal.releases import OFF

ENTER = "\x1b[?1049h\x1b[?25l\x1b[?2004h"
LEAVE = "\x1b[?2026l\x1b[?2004l\x1b[0m\x1b[?25h\x1b[H\x1b[J\x1b[?1049l"
"""Left empty, with the cursor at the top: tmux would keep rows of it, where the window was resized, else."""
DRAINED_WITHIN = 0.5
"""s that leaving waits for a terminal that takes nothing in."""
FALLBACK_SIZE = (80, 24)
INPUT_OFF = termios.IXON | termios.ICRNL | termios.INLCR | termios.IGNCR | termios.BRKINT | termios.ISTRIP
LOCAL_OFF = termios.ECHO | termios.ICANON | termios.ISIG | termios.IEXTEN


class Terminal:
    """Keys in, frames out.

    Raises DeviceError where there is no terminal; hang-ups raise EOFError from `read` alone.
    """

    def __init__(self, fd: int | None = None) -> None:
        self.name = terminal_name(find_terminal() if fd is None else fd)
        self._dumb = os.environ.get("TERM", "dumb") in ("", "dumb")
        self.color = wants_color(os.environ)
        self.unicode = speaks_unicode(os.environ, getattr(sys.stdout, "encoding", None))
        self.resumed = 0
        """How often the process was stopped and went on."""
        self._fd = -1
        self._continued = False
        self._resized = False
        self._saved: list[Any] = []
        self._handlers: dict[int, Any] = {}
        self._shown: list[str] = []
        self._shown_size = (0, 0)
        self._pending = b""
        self._undo: list[str] = []
        """What gives the terminal back, the last first; nothing while it is not taken."""

    def __enter__(self) -> Self:
        # a file of its own: O_NONBLOCK on standard input would be the shell's as well
        try:
            self._fd = os.open(self.name, os.O_RDWR | os.O_NONBLOCK | os.O_NOCTTY | os.O_CLOEXEC)
        except OSError as error:
            raise DeviceError(
                f"cannot open the terminal {self.name}: {error.strerror}; open a new one"
            ) from None
        try:
            self._saved = termios.tcgetattr(self._fd)
            with suppress(ValueError):  # outside the main thread nobody may handle signals
                self._handlers[signal.SIGCONT] = signal.signal(signal.SIGCONT, self._on_continue)
                self._handlers[signal.SIGWINCH] = signal.signal(signal.SIGWINCH, self._on_resize)
            self._enter()
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *exc: object) -> None:
        if self._fd < 0:
            return
        try:
            self._leave()
        finally:
            for number, handler in self._handlers.items():
                signal.signal(number, handler)
            self._handlers.clear()
            os.close(self._fd)
            self._fd = -1

    @property
    def farewell(self) -> str:
        """What gives back a terminal in which anything may have been changed."""
        return "\r\n" if self._dumb else OFF + LEAVE

    def fileno(self) -> int:
        """Return what turns readable when a key was pressed."""
        return self._fd

    def read(self) -> bytes:
        """Return what was typed, b"" for nothing; EOFError when the terminal has gone."""
        self._resume()
        try:
            data = os.read(self._fd, 4096)
        except BlockingIOError:
            return b""
        except OSError as error:
            raise EOFError("the terminal has hung up") from error
        if not data:
            raise EOFError("the terminal has hung up")
        return data

    def draw(self, lines: Sequence[str]) -> None:
        """Show these lines, writing only those that changed; a terminal that is behind skips frames."""
        self._resume()
        self._push()
        if self._pending:
            return
        if self._resized:
            self._resized = False
            self.redraw()
        size = self.size()
        lines = list(lines[: size[1]])
        self._pending = self._encode(self._frame(lines, size))
        self._shown, self._shown_size = lines, size
        self._push()

    def redraw(self) -> None:
        """Write every line anew at the next draw."""
        self._shown_size = (0, 0)
        self._shown = []

    def say(self, text: str) -> bool:
        """Write a question or a command behind what is on its way; False where nothing would answer."""
        if self._dumb:
            return False
        self._pending += text.encode()
        self._push()
        return True

    def switch_on(self, on: str, off: str) -> bool:
        """Write what changes a mode, and at the end what changes it back; False when it was on already."""
        if off in self._undo:
            return False
        self._undo.append(off)
        return self.say(on)

    def suspend(self) -> None:
        """Give the terminal back and stop, as Ctrl-Z does; go on where the shell says so."""
        self._leave()
        previous = signal.signal(signal.SIGTSTP, signal.SIG_DFL)
        os.kill(0, signal.SIGTSTP)
        signal.signal(signal.SIGTSTP, previous)
        self._continued = False
        self._enter()
        self.resumed += 1

    def size(self) -> tuple[int, int]:
        """Return columns and rows; a terminal without a cursor has one row."""
        try:
            columns, rows = os.get_terminal_size(self._fd)
        except OSError:
            columns, rows = FALLBACK_SIZE
        return columns or FALLBACK_SIZE[0], 1 if self._dumb else rows or FALLBACK_SIZE[1]

    def _enter(self) -> None:
        self._undo = self._undo or ["\r\n" if self._dumb else LEAVE]
        with suppress(termios.error):  # hung up: the next read says so
            termios.tcsetattr(self._fd, termios.TCSANOW, raw_mode(self._saved))
            termios.tcflush(self._fd, termios.TCIFLUSH)
        self._pending = b""
        self.redraw()
        self._write_all("" if self._dumb else ENTER)

    def _leave(self) -> None:
        if not self._undo:
            return
        # in the background the shell owns the modes, and SIGTTOU would stop us here for good
        masked = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTTOU})
        try:
            self._write_all("".join(reversed(self._undo)))
        finally:
            if in_foreground(self._fd):
                with suppress(termios.error):
                    termios.tcflush(self._fd, termios.TCIFLUSH)
                    termios.tcsetattr(self._fd, termios.TCSANOW, self._saved)
            signal.pthread_sigmask(signal.SIG_SETMASK, masked)
        self._undo = []

    def _on_continue(self, _signal: int, _frame: FrameType | None) -> None:
        self._continued = True

    def _on_resize(self, _signal: int, _frame: FrameType | None) -> None:
        self._resized = True  # also when the size is the old one again: the terminal has cut its lines

    def _resume(self) -> None:
        """After a stop from outside the shell may have changed every mode."""
        if self._continued:
            self._continued = False
            self._enter()
            self.resumed += 1

    def _frame(self, lines: Sequence[str], size: tuple[int, int]) -> str:
        if self._dumb:
            return one_line(lines, size[0]) if lines != self._shown else ""
        return changes(lines, None if size != self._shown_size else self._shown)

    def _encode(self, text: str) -> bytes:
        return text.encode("utf-8" if self.unicode else "ascii", "replace")

    def _push(self) -> None:
        """Write what the terminal takes now; the rest of the frame waits."""
        if not self._pending:
            return
        try:
            self._pending = self._pending[os.write(self._fd, self._pending) :]
        except BlockingIOError:
            pass
        except OSError:  # hung up: the next read says so
            self._pending = b""
            self.redraw()

    def _write_all(self, text: str) -> None:
        self._pending = self._encode(text)
        self._push()
        while self._pending and select.select([], [self._fd], [], DRAINED_WITHIN)[1]:
            self._push()
        self._pending = b""


def find_terminal() -> int:
    """Return the file of standard input, else output, that is a terminal; DeviceError for neither."""
    for stream in (sys.stdin, sys.stdout):
        with suppress(OSError, ValueError, AttributeError):
            if os.isatty(stream.fileno()):
                return stream.fileno()
    raise DeviceError(
        "expected a terminal to read keys from, found neither standard input nor output connected to one; "
        "run it in a terminal, or with `ssh -t`"
    )


def terminal_name(fd: int) -> str:
    """Return the path that opens the same terminal again."""
    try:
        name = os.ttyname(fd)
        os.close(os.open(name, os.O_RDWR | os.O_NOCTTY))
    except OSError as error:
        if error.errno == errno.ENOTTY:
            raise DeviceError(
                f"expected a terminal, found file {fd}, which is none; run it in a terminal"
            ) from None
        return "/dev/tty"  # a container sees its terminal under no other name, nor may `su` open it
    return name


def raw_mode(found: list[Any]) -> list[Any]:
    """Return the modes that hand every key to us, Ctrl-C too, and leave output as it was."""
    special = list(found[6])
    special[termios.VMIN], special[termios.VTIME] = 1, 0
    return [found[0] & ~INPUT_OFF, *found[1:3], found[3] & ~LOCAL_OFF, *found[4:6], special]


def in_foreground(fd: int) -> bool:
    """Return whether the terminal is ours to set; one that controls nobody is."""
    try:
        return os.tcgetpgrp(fd) == os.getpgrp()
    except OSError:
        return True
