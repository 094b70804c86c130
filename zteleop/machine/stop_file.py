"""Stops on disk: they outlive processes and reboots, and a file that cannot be read means stopped."""

import os
import threading
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

import msgspec

from zteleop.machine import signals
from zteleop.messages import Stop

UNREADABLE = 2**53 - 2
"""The id of the stop that a file stands for whose content nobody can read; all who look must agree on it."""
_LONGEST = 2**17
"""bytes; 64 stops with long reasons are half of that"""


class StopFile:
    """Keeps one robot's stops; what cannot be kept is said to `warn`, and tried again by `tend`."""

    def __init__(self, path: Path, warn: Callable[[str], object]) -> None:
        self.path = path
        self._warn = warn
        self._past = path.with_name(f"{path.name}.released")
        self._stops: tuple[Stop, ...] = ()
        self._looked: tuple[int, ...] = ()
        self._ids: frozenset[int] = frozenset()
        self.unkept = ""
        """Why the stops would not outlive a restart; empty when they would."""

    def exists(self) -> bool:
        """Say whether the robot is stopped by this file; what cannot be looked at is there."""
        return self._stat() != ()

    def load(self) -> list[Stop]:
        """Return the stops kept; none only where there is no file."""
        if not self.exists():
            return []
        try:
            stops = msgspec.json.decode(_read(self.path), type=list[Stop])
        except (OSError, msgspec.DecodeError, UnicodeDecodeError):
            stops = []
        if not stops:
            why = f"{self.path} is there and cannot be read"
            return [Stop(engaged=True, id=UNREADABLE, by="nobody known", why=why[-200:])]
        return [msgspec.structs.replace(stop, engaged=True) for stop in stops]

    def ids(self) -> frozenset[int]:
        """Return the ids of the stops kept; as cheap as one look while the file stays as it is."""
        looked = self._stat()
        if looked != self._looked:
            self._ids, self._looked = frozenset(stop.id for stop in self.load()), looked
        return self._ids

    def promise(self, stops: Sequence[Stop]) -> None:
        """Say what is to be kept; `tend` does it."""
        self._stops, self.unkept = tuple(stops), self.unkept or "they are being written"

    def keep(self, stops: Sequence[Stop]) -> None:
        """Keep these stops, at once for other processes; the disk itself is written behind our back."""
        self._stops = tuple(stops)
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            _write(self.path, msgspec.json.encode(self._stops))
        except OSError as error:
            why = f"{self.path}: {error.strerror}"
            if why != self.unkept:
                self._warn(f"the stop holds, but not across a restart: {why}")
            self.unkept = why
            return
        self.unkept = ""
        # An SD card may take a second for it; the loop that keeps the robot at rest must not wait.
        signals.start(threading.Thread(target=_flush, args=(self.path,), daemon=True))

    def add(self, stop: Stop) -> None:
        """Keep a stop beside those that another process has kept."""
        self.keep([*(kept for kept in self.load() if kept.by != stop.by), stop])

    def tend(self) -> None:
        """Try again what could not be kept."""
        if self.unkept:
            self.keep(self._stops)

    def released(self) -> int:
        """Return the id of the last stop that was released; 0 where none is known."""
        try:
            return msgspec.json.decode(_read(self._past), type=Stop).id or 1
        except OSError:
            return 0
        except (msgspec.DecodeError, UnicodeDecodeError):
            return 1

    def release(self, said: Stop, rest: Sequence[Stop]) -> bool:
        """Keep only the rest, and that a stop was released; False, in words, where the last one stays."""
        with suppress(OSError):
            _write(self._past, msgspec.json.encode(said))
        if rest:
            self.keep(
                rest
            )  # where that fails the robot is stopped all the same, by one of these or nobody known
            return True
        try:
            self.path.unlink(missing_ok=True)
        except OSError as error:
            self._warn(f"the stop cannot be released: {self.path}: {error.strerror}; remove it by hand")
            return False
        self._stops, self.unkept = (), ""
        signals.start(threading.Thread(target=_flush, args=(self.path.parent,), daemon=True))
        return True

    def _stat(self) -> tuple[int, ...]:
        """Return what changes when the file does; () where there is none."""
        try:
            found = os.stat(self.path)
        except (FileNotFoundError, NotADirectoryError):
            return ()
        except OSError as error:
            return (error.errno or 0,)
        return found.st_ino, found.st_mtime_ns, found.st_size


def _read(path: Path) -> bytes:
    """Return a file's bytes; a pipe in its place would be waited for, for ever."""
    file = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    try:
        return os.read(file, _LONGEST)
    finally:
        os.close(file)


def _write(path: Path, text: bytes) -> None:
    file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_TRUNC | os.O_NONBLOCK, 0o644)
    try:
        os.write(file, text)
    finally:
        os.close(file)


def _flush(path: Path) -> None:
    try:
        file = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    except OSError:
        return
    try:
        os.fsync(file)
    except OSError:
        pass
    finally:
        os.close(file)
