"""Which processes of zteleop run on this machine, and which of them nobody sits before."""

import os
import re
import subprocess
from collections.abc import Iterator
from contextlib import suppress
from typing import NamedTuple

PS = ("ps", "-axww", "-o", "pid=,ppid=,tty=,stat=,etime=,command=")
"""what Linux and macOS understand alike"""
LINE = re.compile(r"\s*(\d+)\s+(\d+)\s+(\S+)\s+(\S+)\s+(\S+)\s+(.*)")
PYTHON = re.compile(r"python[\d.]*", re.IGNORECASE)
NAMES = ("zteleop", "zteleop.processes")
NO_TERMINAL = "?-"
"""how ps says it: ?, ?? or -"""
PATIENCE = 5.0


class Running(NamedTuple):
    """A process that somebody typed, or that a service started."""

    pid: int
    verb: str
    age: str
    """as ps says it: 2-13:05:11"""
    seated: bool
    """It belongs to a terminal."""
    frozen: bool = False
    """It was stopped, as Ctrl-Z or `kill -STOP` do."""


def running() -> list[Running] | None:
    """Return each process of zteleop that no other one started, but this; None where nobody can tell."""
    with suppress(OSError, subprocess.SubprocessError):
        told = subprocess.run(
            PS, capture_output=True, text=True, errors="replace", timeout=PATIENCE, check=True
        )
        return [process for process in read(told.stdout) if process.pid != os.getpid()]
    return None


def read(told: str) -> Iterator[Running]:
    """Yield what ps tells, without those that another one started."""
    found: dict[str, tuple[str, Running]] = {}
    for line in told.splitlines():
        if not (words := LINE.match(line)):
            continue
        pid, parent, terminal, state, age, command = words.groups()
        if verb := _verb(command.split()):
            seated, frozen = terminal.strip(NO_TERMINAL) != "", state.startswith("T")
            found[pid] = parent, Running(int(pid), verb, age, seated, frozen)
    yield from (process for parent, process in found.values() if parent not in found)


def _verb(words: list[str]) -> str:
    """Return the verb of a command of zteleop; empty for any other command."""
    if words and PYTHON.fullmatch(os.path.basename(words[0])):
        words = words[2:] if words[1:2] == ["-m"] else words[1:]
    return words[1] if len(words) > 1 and os.path.basename(words[0]) in NAMES else ""
