"""The door as the watchdog sees it: a process that may break, and is ended and started again."""

import os
import signal
import socket
import subprocess
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

from zteleop.control.deadlines import DOOR_SILENCE, DOOR_START, LATE_STEP, LONGEST_OPENING

ALIVE = b"."
"""What a door says to its watchdog every `ALIVE_EVERY` s."""
ALIVE_EVERY = 0.05
LARGEST = 192 * 2**20
"""bytes of memory; strangers fill it, and the robot's own processes need the rest of the machine"""
MALLOC = {"MALLOC_ARENA_MAX": "1"}
"""for glibc: where each thread has an arena of its own, what thousands of sessions leave is not used again"""
WEIGH_EVERY = 0.5
FIRST_PAUSE, LONGEST_PAUSE = 0.1, 5.0
"""s between an end and the next start, doubled each time; none at first, and once one has lived for STEADY"""
STEADY = 10.0
ENDS_WITHIN = 1.0


class Door:
    """Runs `command` with the files of a place to listen at, and of a link, in its arguments."""

    def __init__(
        self,
        command: Sequence[str],
        orders: Callable[[bool], bytes],
        place: str,
        say: Callable[[str], object],
    ) -> None:
        self._command, self._orders, self.place, self.say = command, orders, place, say
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._listener.bind(place)
        self._listener.listen()
        self._process: subprocess.Popen[bytes] | None = None
        self._link: socket.socket | None = None
        self._started = self._heard = self._looked = self._weighed = float("-inf")
        self._patience = DOOR_START
        self._pause = 0.0
        self._due: float | None = None
        self.is_open = self._was_open = False
        self.starts = 0

    @property
    def refused(self) -> int:
        """The exit code of one that ended before any was ever open: its own words have said why."""
        if self._was_open or not self._process:
            return 0
        return max(0, self._process.poll() or 0)

    def start(self, now: float) -> None:
        """Start the process; nobody else holds its end of the link. Raises OSError when the system cannot."""
        self._started, self.is_open = now, False
        self._link, theirs = socket.socketpair()
        self._link.setblocking(False)
        with theirs:
            files = [self._listener.fileno(), theirs.fileno()]
            self._process = subprocess.Popen(
                [*self._command, *map(str, files)],
                stdin=subprocess.PIPE,
                pass_fds=files,
                start_new_session=True,
                env=MALLOC | os.environ,
            )
        assert self._process.stdin
        with suppress(BrokenPipeError), self._process.stdin as ear:
            ear.write(self._orders(self.starts == 0))
        self._due = None
        self.starts += 1

    def tend(self, now: float) -> None:
        """Notice that it broke, end what is left of it, and start the next when it is time; `now` in s."""
        late, self._looked = now - self._looked > LATE_STEP, now
        if self.refused:
            return
        if self._due is not None:
            if now >= self._due and self._is_gone:
                self._start_again(now)
        elif why := self._listen(now) or ("" if late else self._judge(now)):
            self._break(why, now)

    def _start_again(self, now: float) -> None:
        try:
            self.start(now)
        except OSError as error:  # no memory, or no more processes: that ends nobody who guards the chip
            self._break(f"none can be started ({error.strerror})", now)

    def close(self) -> None:
        """Ask it to end, and see to it."""
        if self._link:
            self._link.close()
        if self._process:
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(ENDS_WITHIN)
            self._kill()
            self._process.wait()
        self._listener.close()

    def _listen(self, now: float) -> str:
        """Take in what it said; return why it is no more."""
        assert self._link
        try:
            while said := self._link.recv(4096):
                self._heard = now
                if not self.is_open and said:
                    self._open(now)
        except BlockingIOError:
            return ""
        except OSError:
            pass
        if not self._was_open and self._process:
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(ENDS_WITHIN)
            if self.refused:
                return ""
        return "it ended"

    def _open(self, now: float) -> None:
        self.is_open, self._was_open, self._patience = True, True, DOOR_START
        if self.starts > 1:
            self.say(f"the door is open again, {now - self._started:.1f} s after its start")

    def _judge(self, now: float) -> str:
        """Return what it is to be ended for."""
        if not self.is_open:
            if now - self._started <= self._patience:
                return ""
            had, self._patience = self._patience, min(2 * self._patience, LONGEST_OPENING)
            return f"it did not open within {had:g} s of its start, and the next has {self._patience:g} s"
        if now - self._heard > DOOR_SILENCE:
            return f"it was silent for {now - self._heard:.1f} s"
        if now - self._weighed > WEIGH_EVERY:
            self._weighed = now
            weight = self._weigh()
            if weight > LARGEST:
                return f"it had grown to {weight // 2**20} MB, of {LARGEST // 2**20}"
        return ""

    def _break(self, why: str, now: float) -> None:
        if now - self._started > STEADY:
            self._pause = 0.0
        self._due = now + self._pause
        pause, self._pause = self._pause, min(max(FIRST_PAUSE, 2 * self._pause), LONGEST_PAUSE)
        after = f" in {pause:g} s" if pause else ""
        self._kill()
        if self._link:
            self._link.close()
        self.say(f"the door to the bus is shut: {why}; another opens{after}, and nobody drives meanwhile")

    def _kill(self) -> None:
        if self._process:
            with suppress(OSError):
                self._process.send_signal(signal.SIGKILL)

    @property
    def _is_gone(self) -> bool:
        return self._process is None or self._process.poll() is not None

    def _weigh(self) -> int:
        """Return the bytes of memory that it holds by itself; nothing where the system does not tell."""
        assert self._process
        with suppress(OSError, ValueError, IndexError):
            pages = Path(f"/proc/{self._process.pid}/statm").read_text().split()
            return (int(pages[1]) - int(pages[2])) * os.sysconf("SC_PAGE_SIZE")
        return 0
