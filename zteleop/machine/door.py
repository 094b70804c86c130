"""The door as the watchdog sees it: a process that may break, and is ended and started again."""

import os
import signal
import socket
import subprocess
from collections.abc import Callable, Sequence
from contextlib import suppress

from zteleop.control.deadlines import LATE_STEP
from zteleop.machine.backoff import BackOff
from zteleop.machine.vigil import Vigil

ALIVE = b"."
"""What a door says to its watchdog every `ALIVE_EVERY` s."""
ALIVE_EVERY = 0.1
MALLOC = {"MALLOC_ARENA_MAX": "1"}
"""for glibc: where each thread has an arena of its own, what thousands of sessions leave is not used again"""
ENDS_WITHIN = 1.0


class Door:
    """Runs `command` with the files of a place to listen at, and of a link, in its arguments."""

    def __init__(
        self,
        command: Sequence[str],
        orders: Callable[[bool], bytes],  # for the first one, or a later one
        place: str,
        tell: Callable[[str], object],
    ) -> None:
        self._command = command
        self._orders = orders
        self.place = place
        self.tell = tell
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._listener.bind(place)
        self._listener.listen()
        self._process: subprocess.Popen[bytes] | None = None
        self._link: socket.socket | None = None
        self._vigil = Vigil()
        self._backoff = BackOff(first=0.0)
        self._looked = float("-inf")
        self._due: float | None = None
        self.is_open = False
        self._was_open = False
        self.starts = 0

    @property
    def refused(self) -> int:
        """The exit code of one that ended before any was ever open: its own words have said why."""
        if self._was_open or not self._process:
            return 0
        return max(0, self._process.poll() or 0)

    def start(self, now: float) -> None:
        """Start the process; nobody else holds its end of the link. Raises OSError when the system cannot."""
        self._vigil.begin(now)
        self.is_open = False
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
        late = now - self._looked > LATE_STEP
        self._looked = now
        if self.refused:
            return
        if self._due is not None:
            if now >= self._due and self._is_gone:
                self._start_again(now)
            return
        why = self._listen(now)
        if not why and not late:  # who came late himself has not heard what was said in time
            why = self._judge(now)
        if why:
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
            while self._link.recv(4096):
                self._vigil.hear(now, first=not self.is_open)
                if not self.is_open:
                    self._open(now)
        except BlockingIOError:
            return ""
        except OSError:
            pass  # a link that is reset says the same as one that ends: the process is gone
        if not self._was_open and self._process:
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(ENDS_WITHIN)
            if self.refused:
                return ""
        return "it ended"

    def _open(self, now: float) -> None:
        self.is_open = True
        self._was_open = True
        if self.starts > 1:
            self.tell(f"the door is open again, {now - self._vigil.started:.1f} s after its start")

    def _judge(self, now: float) -> str:
        assert self._process
        return self._vigil.judge(self._process.pid, self.is_open, now)

    def _break(self, why: str, now: float) -> None:
        pause = self._backoff.pause(now - self._vigil.started)
        self._due = now + pause
        after = f" in {pause:g} s" if pause else ""
        self.is_open = False
        self._kill()
        if self._link:
            self._link.close()
        self.tell(f"the door to the bus is shut: {why}; another opens{after}, and nobody drives meanwhile")

    def _kill(self) -> None:
        if self._process:
            with suppress(OSError):
                self._process.send_signal(signal.SIGKILL)

    @property
    def _is_gone(self) -> bool:
        return self._process is None or self._process.poll() is not None
