"""The input devices of this machine that fit, those plugged in later included: looked for once a second."""

import errno
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from struct import calcsize
from typing import Literal, NamedTuple

from zteleop.errors import DeviceError
from zteleop.inputs.evdev.device import Event, EventDevice, bits

FOLDER = "/dev/input"
SYSFS = "/sys/class/input"
LOOK_EVERY = 1.0
"""s between two looks for what was plugged in"""
Fits = Callable[[frozenset[int], frozenset[int], str], bool]
"""(keys, axes, name) to whether a device is meant"""


class Change(NamedTuple):
    """What became of a device."""

    device: EventDevice
    what: Literal["plugged", "moved", "unplugged"]
    events: list[Event] = []


class Devices:
    """Every device that fits, open; DeviceError on a system without Linux's event devices."""

    def __init__(self, fits: Fits) -> None:
        if not sys.platform.startswith("linux"):
            raise DeviceError(f"expected Linux's {FOLDER}, found {sys.platform}, which has none")
        from select import epoll

        self._fits = fits
        self._open: list[EventDevice] = []
        self._seen: dict[str, object] = {}
        self._due = float("-inf")
        self._epoll = epoll()
        self.refused: dict[str, str] = {}
        """path to name of those that fit, but this user may not read"""

    @property
    def open(self) -> tuple[EventDevice, ...]:
        """The devices there are now, in the order they came."""
        return tuple(self._open)

    def fileno(self) -> int:
        """Return what turns readable when anything happens at any of them."""
        return self._epoll.fileno()

    def close(self) -> None:
        """Let go of all of them."""
        while self._open:
            self._open.pop().close()
        self._epoll.close()

    def read(self, now: float) -> list[Change]:
        """Return what happened since the last time, in order at each device."""
        changes = [change for device in self.open if (change := self._read(device))]
        if now >= self._due:
            self._due = now + LOOK_EVERY
            changes += [Change(device, "plugged") for device in self._look()]
        return changes

    def _read(self, device: EventDevice) -> Change | None:
        try:
            events = device.read()
        except OSError:  # ENODEV
            self.drop(device)
            return Change(device, "unplugged")
        return Change(device, "moved", events) if events else None

    def drop(self, device: EventDevice) -> None:
        """Give up a device; it is found again when it is plugged in anew."""
        self._open.remove(device)
        device.close()  # which also ends its place in the epoll

    def _look(self) -> list[EventDevice]:
        found = dict(nodes())
        new = [path for path, node in found.items() if self._seen.get(path) != node]
        self._seen = found
        self.refused = {path: name for path, name in self.refused.items() if path in found}
        return [device for path in new if (device := self._try(path))]

    def _try(self, path: str) -> EventDevice | None:
        self.refused.pop(path, None)
        try:
            device = EventDevice(path)
        except OSError as error:
            if error.errno in (errno.EACCES, errno.EPERM):
                self._note_refusal(path)
            return None
        if not self._fits(device.keys, device.axes, device.name):
            device.close()
            return None
        self._epoll.register(device.fileno())
        self._open.append(device)
        return device

    def _note_refusal(self, path: str) -> None:
        about = Path(SYSFS, os.path.basename(path), "device")
        with suppress(OSError, ValueError):
            name = (about / "name").read_text(errors="replace").strip()
            keys, axes = (capabilities(about / "capabilities" / kind) for kind in ("key", "abs"))
            if self._fits(keys, axes, name):
                self.refused[path] = name


def nodes() -> Iterator[tuple[str, object]]:
    """Yield each event device's path, and what changes with the device behind it and its permissions."""
    try:
        names = sorted(os.listdir(FOLDER), key=lambda name: (len(name), name))
    except OSError:
        return
    for name in names:
        with suppress(OSError):
            if name.startswith("event"):
                found = os.stat(f"{FOLDER}/{name}")
                yield f"{FOLDER}/{name}", (found.st_ino, found.st_rdev, found.st_ctime_ns)


def capabilities(file: Path) -> frozenset[int]:
    """Return the bits of a capability as sysfs says them: words in hex, the highest first."""
    words = [int(word, 16) for word in file.read_text().split()]
    size = calcsize("l")
    return frozenset(bits(b"".join(word.to_bytes(size, "little") for word in reversed(words))))


def may_not_read(refused: dict[str, str], what: str) -> str:
    """Return the sentence for devices that are there, but not for this user."""
    found = ", ".join(f"{name} ({path})" for path, name in sorted(refused.items()))
    return (
        f"expected {what} that this user may read, found {found}, which only the group input may; "
        "say `sudo usermod -aG input $USER` and log in again, but know what that means: "
        "every program of yours can then read every key typed on this machine"
    )
