"""Limits that were changed while a robot ran, on disk: who made it slow finds it slow after a restart."""

import os
from contextlib import suppress
from pathlib import Path

import msgspec

from zteleop.errors import DeviceError


class LimitsFile:
    """Keeps values by their names."""

    def __init__(self, path: Path) -> None:
        self._path = path

    def load(self) -> dict[str, float]:
        """Return what is kept; raises DeviceError for a file that is there and cannot be read."""
        try:
            return msgspec.json.decode(self._path.read_bytes(), type=dict[str, float])
        except FileNotFoundError:
            return {}
        except (OSError, msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
            words = getattr(error, "strerror", None) or "it is no list of limits"
            raise DeviceError(f"{self._path} cannot be read: {words}") from None

    def keep(self, values: dict[str, float]) -> None:
        """Keep these and no others; raises DeviceError when that is not possible."""
        new = self._path.with_name(f"{self._path.name}.new")
        try:
            if not values:
                self._path.unlink(missing_ok=True)
                return
            self._path.parent.mkdir(parents=True, exist_ok=True)
            new.write_bytes(msgspec.json.encode(values))
            os.replace(new, self._path)
        except OSError as error:
            with suppress(OSError):
                new.unlink(missing_ok=True)
            raise DeviceError(f"{self._path}: {error.strerror}") from None
