"""A real process on a real pseudo-terminal that controls it, under a leader that does what a shell does."""

import os
import pty
import select
import signal
import subprocess
import sys
import termios
import time
from collections.abc import Callable
from fcntl import ioctl
from struct import pack

import pyte
import pytest

LEADER = """
import fcntl, os, signal, sys, termios

program, events, commands = sys.argv[1], int(sys.argv[2]), int(sys.argv[3])
fcntl.ioctl(0, termios.TIOCSCTTY, 0)
signal.signal(signal.SIGTTOU, signal.SIG_IGN)
job = os.fork()
if job == 0:
    os.setpgid(0, 0)
    os.tcsetpgrp(0, os.getpid())
    signal.signal(signal.SIGTTOU, signal.SIG_DFL)
    os.execv(sys.executable, [sys.executable, "-c", program])
os.write(events, f"started {job}\\n".encode())
while True:
    _, status = os.waitpid(job, os.WUNTRACED)
    if not os.WIFSTOPPED(status):
        break
    os.tcsetpgrp(0, os.getpgrp())
    os.write(events, b"stopped\\n")
    os.read(commands, 1)
    os.tcsetpgrp(0, job)
    os.killpg(job, signal.SIGCONT)
os.write(events, f"exit {os.waitstatus_to_exitcode(status)}\\n".encode())
"""
PROGRAM = """
import select, signal, sys, time

from zteleop.control.stick import Speeds
from zteleop.inputs.keyboard import Keyboard
from zteleop.screen.render import Dashboard, render
from zteleop.screen.view import View
from zteleop.messages import Channel, Vehicle


def end(number, frame):
    raise SystemExit(128 + number)


for number in (signal.SIGTERM, signal.SIGHUP):
    signal.signal(number, end)
channels = [Channel(n, i, 1.0, 2.0, 3.0, 290, 375, 460, 0) for i, n in enumerate(("steering", "throttle"))]
car = Vehicle("ackermann", channels, 1.0, 2.0, 0.25, 0.4, 5.0, 4.08, True, 9.0)
with Keyboard("step") as keyboard:
    keyboard.fit(car)
    while not keyboard.finished:
        now = time.monotonic()
        keyboard.read(now)
        if keyboard.suspending:
            keyboard.suspend(now)
        stick = keyboard.stick(now)
        note = f"forward {stick.forward:.3f} resumed {keyboard.terminal.resumed}"
        lines = render(
            Dashboard("archangel", "step", Speeds(), View(vehicle=car, note=note)),
            *keyboard.terminal.size(), unicode=keyboard.terminal.unicode, color=keyboard.terminal.color,
        )
        keyboard.terminal.draw(lines)
        if FAIL and stick.deadman:
            raise RuntimeError("boom")
        select.select([keyboard], [], [], 0.05)
"""
DEADLINE = 20.0
UP = b"\x1b[A"


class Session:
    """A terminal, what it shows, and the program in its foreground."""

    def __init__(self, fail: bool = False) -> None:
        self.master, self.slave = pty.openpty()
        ioctl(self.slave, termios.TIOCSWINSZ, pack("HHHH", 24, 80, 0, 0))
        self.found = self.modes()
        self.screen = pyte.Screen(80, 24)
        self.stream = pyte.ByteStream(self.screen)
        self.output = self.said = b""
        self.events, events = os.pipe()
        commands, self.commands = os.pipe()
        self.leader = subprocess.Popen(
            [sys.executable, "-c", LEADER, PROGRAM.replace("FAIL", str(fail)), str(events), str(commands)],
            stdin=self.slave,
            stdout=self.slave,
            stderr=self.slave,
            start_new_session=True,
            pass_fds=(events, commands),
            env={**os.environ, "TERM": "xterm-256color", "LC_ALL": "C.UTF-8"},
        )
        os.close(events)
        os.close(commands)
        self.wait(lambda: b"started" in self.said)
        self.job = int(self.said.split()[1])

    def close(self) -> None:
        if b"exit" not in self.said:
            os.kill(self.job, signal.SIGKILL)
            self.leader.kill()
        self.leader.wait()
        for fd in (self.master, self.slave, self.events, self.commands):
            os.close(fd)

    def modes(self) -> list:
        return termios.tcgetattr(self.slave)

    def wait(self, condition: Callable[[], bool]) -> None:
        """Take in what is shown and said until the condition holds."""
        end = time.monotonic() + DEADLINE
        while not condition():
            sources = [self.master] if b"exit" in self.said else [self.master, self.events]
            ready = select.select(sources, [], [], max(0.0, end - time.monotonic()))[0]
            if not ready or time.monotonic() > end:
                pytest.fail(f"waited in vain; the screen shows\n{self.shown()}\n{self.said!r}")
            if self.master in ready:
                data = os.read(self.master, 65536)
                self.output += data
                self.stream.feed(data)
            if self.events in ready:
                self.said += os.read(self.events, 1024)
                if b"exit" in self.said:  # nothing more can come but what is on its way
                    end = min(end, time.monotonic() + 2.0)

    def shown(self) -> str:
        return "\n".join(self.screen.display)

    def expect(self, text: str) -> None:
        self.wait(lambda: text in self.shown())

    def type(self, data: bytes) -> None:
        os.write(self.master, data)

    def ended(self) -> int:
        self.wait(lambda: b"exit" in self.said)
        return int(self.said.split()[-1])

    def is_left(self) -> bool:
        """The alternate screen was left, the cursor shown, paste brackets are off: each was said last."""
        return all(
            self.output.rfind(b"\x1b[?%s" % off) > self.output.rfind(b"\x1b[?%s" % on)
            for on, off in ((b"1049h", b"1049l"), (b"25l", b"25h"), (b"2004h", b"2004l"))
        )

    def expect_as_found(self) -> None:
        self.wait(self.is_left)
        assert self.modes() == self.found


@pytest.fixture
def session():
    session = Session()
    yield session
    session.close()


def test_keys_drive_and_the_screen_shows_it(session):
    session.expect("Currently outputting:[Steering PWM, Throttle PWM] = ")
    session.expect("forward 0.000")
    assert session.modes() != session.found
    session.type(UP + UP)
    session.expect("forward 0.024")


@pytest.mark.parametrize("key", [b"q", b"\x03"])
def test_q_and_ctrl_c_end_and_leave_the_terminal_as_found(session, key):
    session.expect("forward 0.000")
    session.type(UP + key)
    assert session.ended() == 0
    session.expect_as_found()


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP])
def test_signals_leave_the_terminal_as_found(session, number):
    session.expect("forward 0.000")
    os.kill(session.job, number)
    assert session.ended() == 128 + number
    session.expect_as_found()


def test_an_exception_leaves_the_terminal_as_found_and_its_words_readable():
    session = Session(fail=True)
    try:
        session.expect("forward 0.000")
        session.type(UP)
        assert session.ended() == 1
        session.expect_as_found()
        session.wait(lambda: b"RuntimeError: boom" in session.output[session.output.rfind(b"\x1b[?1049l") :])
    finally:
        session.close()


def test_ctrl_z_gives_the_terminal_back_and_returns_neutral(session):
    session.expect("forward 0.000")
    raw = session.modes()
    session.type(UP)
    session.expect("forward 0.012")
    session.type(b"\x1a")
    session.wait(lambda: b"stopped" in session.said)
    session.expect_as_found()
    session.screen.reset()
    os.write(session.commands, b"c")
    session.expect("forward 0.000 resumed 1")
    session.expect("Currently outputting")
    assert session.modes() == raw
    assert not session.is_left()
    session.type(b"q")
    assert session.ended() == 0
    session.expect_as_found()


def test_a_stop_from_outside_is_survived(session):
    session.expect("forward 0.000")
    raw = session.modes()
    session.type(UP)
    session.expect("forward 0.012")
    os.kill(session.job, signal.SIGSTOP)
    session.wait(lambda: b"stopped" in session.said)
    termios.tcsetattr(session.slave, termios.TCSANOW, session.found)
    session.screen.reset()
    os.write(session.commands, b"c")
    session.expect("forward 0.000 resumed 1")
    assert session.modes() == raw
    session.type(b"q")
    assert session.ended() == 0
    session.expect_as_found()


def test_ended_while_stopped_it_leaves_the_terminal_as_found(session):
    session.expect("forward 0.000")
    session.type(b"\x1a")
    session.wait(lambda: b"stopped" in session.said)
    os.kill(session.job, signal.SIGTERM)
    os.write(session.commands, b"c")
    assert session.ended() == 128 + signal.SIGTERM
    session.expect_as_found()
