"""What the processes of a robot have taken of the machine."""

import time
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

from zteleop.processes import PROGRAMS


class Usage(NamedTuple):
    """What one process holds."""

    pid: int
    mb: float
    """of its own"""
    files: int
    threads: int


LOOKS, BETWEEN = 3, 0.3
"""and s: a door that tries whether it takes newcomers in has three files more for a moment"""


def usage(watchdog: int) -> dict[str, Usage]:
    """Return what the watchdog and whoever it has started hold, by what they do: the least of some looks."""
    found = {}
    for pid in _family(watchdog):
        with suppress(OSError):  # a door may end at any time
            found["watchdog" if pid == watchdog else _name(pid)] = _least(pid)
    return found


def told(found: dict[str, Usage]) -> str:
    """Return it in a line."""
    return ", ".join(f"{name} {own.mb:.1f} MB {own.files} files" for name, own in sorted(found.items()))


def _least(pid: int) -> Usage:
    looks = []
    for _ in range(LOOKS):
        looks.append(_usage(pid))
        time.sleep(BETWEEN)
    return Usage(pid, *(min(found) for found in zip(*(look[1:] for look in looks), strict=True)))


def _usage(pid: int) -> Usage:
    process = Path(f"/proc/{pid}")
    lines = (process / "smaps_rollup").read_text().splitlines()
    mb = sum(int(line.split()[1]) for line in lines if line.startswith("Private_")) / 1024
    return Usage(pid, mb, len(list((process / "fd").iterdir())), len(list((process / "task").iterdir())))


def _family(pid: int) -> list[int]:
    return [pid, *map(int, Path(f"/proc/{pid}/task/{pid}/children").read_text().split())]


def _name(pid: int) -> str:
    command = Path(f"/proc/{pid}/cmdline").read_bytes().split(b"\0")
    return next((name for name in PROGRAMS if name.encode() in command[3:]), "one that is just starting")
