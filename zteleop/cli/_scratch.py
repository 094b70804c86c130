"""A folder that lasts as long as its process; those that outlived theirs go when the next one comes."""

import fcntl
import shutil
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

DEMO = "zteleop-demo-"
"""how the folder of a demo begins, in which its robot keeps what others keep for longer"""
ALIVE = "alive"
"""a file that is locked while somebody uses the folder"""
MADE_WITHIN = 60.0
"""s in which it is locked: a younger folder may be just being made"""


@contextmanager
def scratch(prefix: str) -> Iterator[Path]:
    """Yield a new folder, and remove it at the end; also those of that prefix whose process was killed."""
    _sweep(prefix)
    with tempfile.TemporaryDirectory(prefix=prefix) as name:
        folder = Path(name)
        with (folder / ALIVE).open("w") as file:
            fcntl.flock(file, fcntl.LOCK_EX)
            yield folder


def _sweep(prefix: str) -> None:
    for folder in Path(tempfile.gettempdir()).glob(f"{prefix}*"):
        with suppress(OSError):  # it is somebody else's, or gone meanwhile
            if time.time() - folder.stat().st_mtime > MADE_WITHIN and _is_left(folder):
                shutil.rmtree(folder)


def _is_left(folder: Path) -> bool:
    """Say whether nobody holds the lock any more, which ends with a process however that ends."""
    with (folder / ALIVE).open() as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            return False
        return True
