"""A process of a bench, whose last words are kept."""

import signal
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

ZTELEOP = (sys.executable, "-m", "zteleop")
ENDS_WITHIN = 5.0


class Process:
    """Runs a command in a session of its own; what it says goes to a file.

    One that is leashed has a stdin that ends with this process, however that ends.
    """

    def __init__(
        self,
        name: str,
        command: Sequence[str],
        environment: Mapping[str, str],
        folder: Path,
        terminal: int | None = None,
        *,
        leashed: bool = False,
    ) -> None:
        self.name = name
        self._log = folder / f"{name}.log"
        with self._log.open("ab") as log:
            self._process = subprocess.Popen(
                command,
                env=environment,
                cwd=folder,
                stdin=subprocess.PIPE if leashed else subprocess.DEVNULL if terminal is None else terminal,
                stdout=log if terminal is None else terminal,
                stderr=log if terminal is None else terminal,
                start_new_session=True,
            )

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def ended(self) -> bool:
        return self._process.poll() is not None

    @property
    def code(self) -> int | None:
        """Its exit code; None while it runs."""
        return self._process.poll()

    @property
    def words(self) -> str:
        """The last line that it said."""
        lines = self._log.read_text(errors="replace").strip().splitlines()
        return lines[-1] if lines else "it said nothing"

    def signal(self, number: int) -> None:
        self._process.send_signal(number)

    def end(self) -> None:
        """Ask it to end, and kill it when it does not."""
        for number in (signal.SIGCONT, signal.SIGTERM):
            self.signal(number)
        try:
            self._process.wait(ENDS_WITHIN)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        if self._process.stdin:
            self._process.stdin.close()


def actuator_of(watchdog: int) -> int | None:
    """Return the process that a watchdog has started to obey commands, if there is one now."""
    return _part(watchdog, b"actuator")


def door_of(watchdog: int) -> int | None:
    """Return the process by which a robot is on the bus, if there is one now."""
    return _part(watchdog, b"door")


def _part(watchdog: int, program: bytes) -> int | None:
    wanted = {b"zteleop.processes", program}  # a child that is just being started has its parent's words
    return next((child for child in _children(watchdog) if wanted <= set(_command(child))), None)


def _children(pid: int) -> list[int]:
    try:
        with open(f"/proc/{pid}/task/{pid}/children") as file:
            return [int(child) for child in file.read().split()]
    except OSError:
        return []


def _command(pid: int) -> list[bytes]:
    try:
        with open(f"/proc/{pid}/cmdline", "rb") as file:
            return file.read().split(b"\0")
    except OSError:
        return []
