"""A stop on disk: it outlives processes and reboots, and a file that cannot be read means stopped."""

import os
import secrets
import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

import msgspec

from zteleop.messages import Stop


class StopFile:
    """Keeps one robot's stop; what cannot be kept is said to `warn`, and holds until the robot restarts."""

    def __init__(self, path: Path, warn: Callable[[str], object]) -> None:
        self.path, self._warn = path, warn
        self._past = path.with_name(f"{path.name}.released")

    def exists(self) -> bool:
        """Say whether the robot is stopped by this file; what cannot be looked at is there."""
        try:
            os.stat(self.path)
        except (FileNotFoundError, NotADirectoryError):
            return False
        except OSError:
            return True
        return True

    def load(self) -> Stop | None:
        """Return the stop kept; None only where there is no file."""
        if not self.exists():
            return None
        try:
            stop = msgspec.json.decode(_read(self.path), type=Stop)
            return msgspec.structs.replace(stop, engaged=True)
        except (OSError, msgspec.DecodeError, UnicodeDecodeError):
            why = f"{self.path} is there and cannot be read"
            return Stop(engaged=True, id=secrets.randbits(53), by="nobody known", why=why[-200:])

    def keep(self, stop: Stop) -> None:
        """Keep a stop, at once for other processes; the disk itself is written behind our back."""
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            _write(self.path, msgspec.json.encode(stop))
        except OSError as error:
            self._warn(f"the stop holds, but not across a restart: {self.path}: {error.strerror}")
            return
        # An SD card may take a second for it; the loop that keeps the robot at rest must not wait.
        threading.Thread(target=_flush, args=(self.path,), daemon=True).start()

    def released(self) -> int:
        """Return the id of the last stop that was released; 0 where none is known."""
        try:
            return msgspec.json.decode(_read(self._past), type=Stop).id or 1
        except OSError:
            return 0
        except (msgspec.DecodeError, UnicodeDecodeError):
            return 1

    def remove(self) -> bool:
        """Forget the stop, but not that it was the last; False, in words, where the file stays."""
        try:
            with suppress(OSError):
                _write(self._past, _read(self.path))
            self.path.unlink(missing_ok=True)
        except OSError as error:
            self._warn(f"the stop cannot be released: {self.path}: {error.strerror}; remove it by hand")
            return False
        threading.Thread(target=_flush, args=(self.path.parent,), daemon=True).start()
        return True


def _read(path: Path) -> bytes:
    """Return a file's bytes; a pipe in its place would be waited for, for ever."""
    file = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    try:
        return os.read(file, 4096)
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
