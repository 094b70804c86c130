"""A file or a folder that was not there before: there as a whole in the end, or not at all."""

import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from zteleop.errors import RecordingError, ZteleopError

SUFFIX = ".part"
"""of the name while it is written"""


@contextmanager
def fresh(path: Path, *, folder: bool = False) -> Iterator[Path]:
    """Yield where to write a file, or a folder; afterwards it has its name, or after an error is gone.

    Raises RecordingError when it is there already, and when it cannot be written.
    """
    path = Path(os.path.normpath(path))
    if not path.name:
        raise RecordingError(f"expected the name of a file or a folder, found {str(path)!r}")
    part = path.with_name(f"{path.name}{SUFFIX}")
    refuse(path)
    if os.path.lexists(part):
        raise RecordingError(
            f"{part} is there already: it is being written, or was when something ended; remove it, "
            "or say another name"
        )
    try:
        if folder:
            part.mkdir()
        yield part
        refuse(path)
        part.rename(path)
    except BaseException as error:
        removed = _remove(part)
        if isinstance(error, OSError) and not isinstance(error, ZteleopError):
            raise RecordingError(f"cannot write {path}: {error.strerror or error}{removed}") from None
        raise


def refuse(path: Path) -> None:
    """Raise RecordingError when something is there already."""
    if os.path.lexists(path):
        raise RecordingError(f"{path} is there already, and is not overwritten; say another name")


def _remove(path: Path) -> str:
    """Remove what is there of it; return that in words."""
    if not os.path.lexists(path):
        return ""
    with suppress(OSError):
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink()
    return "; what was written of it is removed"
