"""Processes, with a terminal or without: what they say is awaited, and shown when a test fails."""

import os
import pty
import re
import signal
import subprocess
import sys
import termios
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from fcntl import ioctl
from pathlib import Path
from struct import pack
from typing import IO, Any

import pyte

PATIENCE = 30.0 * float(os.environ.get("ZTELEOP_PATIENCE", "1"))
"""s until an event that is awaited is given up: no claim, only the end of hope"""
ZTELEOP = (sys.executable, "-m", "zteleop")
LAST = b"\0\0\0"
"""What no program says, and no terminal shows."""
TAKE_TERMINAL = """
import fcntl, os, sys, termios
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
os.execv(sys.executable, [sys.executable, *sys.argv[1:]])
"""


class Unmet(AssertionError):  # noqa: N818  not always an error of the product
    """What was awaited never came: a machine alone can do that, which keeps a robot from its core.

    Whoever drove must begin anew then, and a test does not. See `judging.py`.
    """


def until(condition: Callable[[], object], what: str) -> None:
    """Wait for what no event tells of, such as a register; how long it takes is `verdict`'s to judge."""
    began = time.monotonic()
    while not condition():
        if time.monotonic() - began >= PATIENCE:
            raise Unmet(f"not within {PATIENCE:g} s: {what}")
        time.sleep(0.0005)


WORDS = 1500
_started: list["Process"] = []
"""Processes whose words a failed test shows."""


def words() -> list[tuple[str, str]]:
    """Return the command and the last words of every process that was started and not forgotten."""
    return [(" ".join(process.command[-9:])[-100:], _shortened(process.text)) for process in _started]


def _shortened(text: str) -> str:
    """Return the first and the last of many words: what went wrong is often followed by what it led to."""
    return text if len(text) <= 2 * WORDS else f"{text[:WORDS]}\n[...]\n{text[-WORDS:]}"


def pids() -> list[int]:
    """Return every process that was started and runs, an actuator after its watchdog."""
    found = [(process.process.pid, process.child) for process in _started if process.process.poll() is None]
    return [pid for pair in found for pid in pair if pid]


def forget_the_ended() -> None:
    """Leave out the processes of tests that are over."""
    _started[:] = [process for process in _started if process.process.poll() is None]


def descendants(pid: int) -> list[int]:
    """Return the children of a process, and theirs."""
    try:
        children = [int(child) for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except OSError:
        return []
    return children + [further for child in children for further in descendants(child)]


def part(watchdog: int, program: bytes) -> int | None:
    """Return the process of a program that a watchdog started, if there is one now."""
    wanted = {b"zteleop.processes", program}  # one that is just being started has its parent's words
    with suppress(OSError):
        for child in Path(f"/proc/{watchdog}/task/{watchdog}/children").read_text().split():
            if wanted <= set(Path(f"/proc/{child}/cmdline").read_bytes().split(b"\0")):
                return int(child)
    return None


def users_of(folder: str) -> list[str]:
    """Return the command of each process that has a folder for its temporary files."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):  # it ends just now, or is somebody else's
            if f"TMPDIR={folder}".encode() in (process / "environ").read_bytes():
                found.append((process / "cmdline").read_bytes().replace(b"\0", b" ").decode(errors="replace"))
    return found


class Process:
    """A process of its own, whose lines can be awaited."""

    def __init__(self, command: Sequence[str], environment: Mapping[str, str], folder: Path) -> None:
        self._said = threading.Condition()
        self.lines: list[str] = []
        self._start(command, environment, folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)

    def _start(
        self,
        command: Sequence[str],
        environment: Mapping[str, str],
        folder: Path,
        stdin: int,
        stdout: int,
    ) -> None:
        self.process = subprocess.Popen(
            command,
            env=environment,
            cwd=folder,
            stdin=stdin,
            stdout=stdout,
            stderr=subprocess.STDOUT,
            start_new_session=True,
        )
        self.command = command
        self._reader = threading.Thread(target=self._read, args=(self.process.stdout,), daemon=True)
        self._reader.start()
        _started.append(self)

    def _read(self, output: IO[bytes]) -> None:
        for line in output:
            with self._said:
                self.lines.append(line.decode(errors="replace").rstrip("\n"))
                self._said.notify_all()
        with self._said:
            self._said.notify_all()

    @property
    def text(self) -> str:
        return "\n".join(self.lines)

    def says(self, text: str) -> str:
        """Wait for a line that holds a text."""
        with self._said:
            found = self._said.wait_for(lambda: next((x for x in self.lines if text in x), None), PATIENCE)
        if not found:
            raise Unmet(f"never said {text!r}:\n{self.text}")
        return found

    def signal(self, number: int) -> None:
        self.process.send_signal(number)

    @property
    def child(self) -> int | None:
        """The actuator that this process started and watches over, if there is one now."""
        return part(self.process.pid, b"actuator")

    @property
    def door(self) -> int | None:
        """The door that this process started, if there is one now."""
        return part(self.process.pid, b"door")

    @property
    def recorder(self) -> int | None:
        """The black box that this process started, if there is one now."""
        return part(self.process.pid, b"blackbox")

    def ends(self) -> int:
        """Wait for the end; return the exit code."""
        code = self.process.wait(PATIENCE)
        self._reader.join(PATIENCE)
        return code

    def close(self) -> None:
        """End it with all that it started, frozen or not: what ends by itself is for a test to claim."""
        if self.process.poll() is None:
            for pid in [self.process.pid, *descendants(self.process.pid)]:
                with suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)
        self.process.wait()
        self._reader.join(PATIENCE)
        if self.process.stdout:
            self.process.stdout.close()


class Terminal(Process):
    """A process in the foreground of a terminal that controls it; what is shown can be awaited."""

    def __init__(
        self,
        arguments: Sequence[str],
        environment: Mapping[str, str],
        folder: Path,
        columns: int = 80,
        rows: int = 24,
        tells_releases: bool = False,
    ) -> None:
        self._said = threading.Condition()
        self._answered = 0
        self._tells_releases = tells_releases
        self.flags = [0]
        """Of kitty's keyboard protocol, as they were pushed."""
        self.silent = False
        """It answers nothing, as one behind a link that stalls."""
        self._screen = pyte.Screen(columns, rows)
        self._stream = pyte.ByteStream(self._screen)
        self.output = b""
        self._master, self._slave = pty.openpty()
        self._set_size(columns, rows)
        self.found = self.modes()
        command = [sys.executable, "-c", TAKE_TERMINAL, *arguments]
        self._start(command, environment, folder, stdin=self._slave, stdout=self._slave)

    @property
    def screen(self) -> str:
        with self._said:
            return "\n".join(line.rstrip() for line in self._screen.display)

    def modes(self) -> list[Any]:
        return termios.tcgetattr(self._slave)

    def type(self, keys: str) -> None:
        os.write(self._master, keys.encode())

    def resize(self, columns: int, rows: int) -> None:
        """Do what a terminal's window does when it is dragged larger or smaller."""
        with self._said:
            self._screen.resize(rows, columns)
        self._set_size(columns, rows)

    @property
    def text(self) -> str:
        return self.screen

    def shows(self, *texts: str) -> str:
        """Wait until all these texts are on the screen together; return the screen."""

        def found() -> bool:
            return all(text in "\n".join(self._screen.display) for text in texts)

        with self._said:
            seen = self._said.wait_for(found, PATIENCE)
        if not seen:
            raise Unmet(f"never showed {texts}:\n{self.screen}")
        return self.screen

    def is_as_found(self) -> None:
        """Wait until the terminal is left: its modes, its screen, its cursor and its way to paste."""

        def left() -> bool:
            return all(
                self.output.rfind(b"\x1b[?%s" % off) >= self.output.rfind(b"\x1b[?%s" % on)
                for on, off in ((b"1049h", b"1049l"), (b"25l", b"25h"), (b"2004h", b"2004l"))
            )

        with self._said:
            assert self._said.wait_for(left, PATIENCE), f"not left: {self.output[-200:]!r}"
        assert self.modes() == self.found

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        os.close(self._slave)
        self._reader.join()
        os.close(self._master)

    def ends(self) -> int:
        """Wait for the end, and until all that was said before it has been read; return the exit code."""
        code = self.process.wait(PATIENCE)
        os.write(self._slave, LAST)  # goes the same way as the words, behind them
        with self._said:
            self._said.wait_for(lambda: LAST in self.output, PATIENCE)
            self.output = self.output.replace(LAST, b"")
        return code

    def _set_size(self, columns: int, rows: int) -> None:
        """Set the size; the kernel tells whoever is in the foreground by SIGWINCH."""
        ioctl(self._slave, termios.TIOCSWINSZ, pack("HHHH", rows, columns, 0, 0))

    def _read(self, output: IO[bytes]) -> None:
        with suppress(OSError):  # EIO: nobody holds the other end any more
            while data := os.read(self._master, 65536):
                with self._said:
                    self.output += data
                    self._answer()
                    self._stream.feed(self.FOREIGN.sub(b"", data))
                    self._said.notify_all()

    FOREIGN = re.compile(rb"\x1b\[[<>]\d*u")
    """What pyte would take for text."""
    QUESTIONS = re.compile(rb"\x1b\[(?:(c)|(\?)u|>(\d+)u|(<)u)")

    def _answer(self) -> None:
        """Answer what the program asks of its terminal, and remember what it sets."""
        for found in self.QUESTIONS.finditer(self.output, self._answered):
            self._answered = found.end()
            attributes, flags, push, pop = found.groups()
            if push:
                self.flags.append(int(push))
            elif pop and len(self.flags) > 1:
                self.flags.pop()
            elif attributes and not self.silent:
                self.type("\x1b[?62;22c")
            elif flags and self._tells_releases and not self.silent:
                self.type(f"\x1b[?{self.flags[-1]}u")

    def key(self, name: str, event: str = "press") -> None:
        """Do to a key what the protocol tells: press, repeat or release it."""
        number = {"press": 1, "repeat": 2, "release": 3}[event]
        final = {"up": "A", "down": "B", "right": "C", "left": "D"}.get(name)
        self.type(f"\x1b[1;1:{number}{final}" if final else f"\x1b[{ord(name)};1:{number}u")
