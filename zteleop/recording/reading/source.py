"""The bytes of a file, asked for by their place."""

from pathlib import Path

from zteleop.errors import RecordingError
from zteleop.recording.reading.records import HEAD, BrokenError


class Source:
    """An open file; raises RecordingError where it cannot be read, BrokenError where it ends too early."""

    def __init__(self, path: Path) -> None:
        self.path = path
        if path.exists() and not path.is_file():
            raise RecordingError(f"expected a file, found none at {path}")
        try:
            self._stream = path.open("rb")
            self.size = path.stat().st_size
        except OSError as error:
            raise RecordingError(f"cannot open {path}: {error.strerror}") from None

    def close(self) -> None:
        self._stream.close()

    def read(self, at: int, length: int) -> bytes:
        """Return so many bytes from a place on; raises BrokenError where there are not so many."""
        if at + length > self.size:
            raise BrokenError("it ends too early")
        found = self.some(at, length)
        if len(found) < length:
            raise BrokenError("it became shorter while it was read")
        return found

    def some(self, at: int, length: int) -> bytes:
        """Return so many bytes from a place on, or as many as there are."""
        if not 0 <= at < self.size:
            return b""
        try:
            self._stream.seek(at)
            return self._stream.read(min(length, self.size - at))
        except OSError as error:
            raise RecordingError(f"cannot read {self.path}: {error.strerror}") from None
        except MemoryError:
            raise BrokenError(f"{length} bytes are more than fit into memory") from None

    def head(self, at: int) -> tuple[int, int]:
        """Return what the record at a place is, and how long; raises BrokenError where there is none."""
        kind, length = HEAD.unpack(self.read(at, HEAD.size))
        return kind, length

    def record(self, at: int, kind: int) -> bytes:
        """Return the record of a kind at a place; raises BrokenError where there is none."""
        found, length = self.head(at)
        if found != kind:
            raise BrokenError(f"expected a record of kind {kind} at byte {at}, found one of kind {found}")
        return self.read(at + HEAD.size, length)
