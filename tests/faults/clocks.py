"""One machine's clocks, which a test may set: its processes see others than everybody else."""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from struct import pack_into

import pytest

SOURCE = Path(__file__).with_suffix(".c")
STRICT = ("-std=gnu11", "-Wall", "-Wextra", "-Werror", "-O2", "-shared", "-fPIC")
_BYTES = 16


class Clocks:
    """The time of day and the time since the start, as a machine's processes see them."""

    def __init__(self, folder: Path, name: str) -> None:
        self._file = folder / f"{name}.clocks"
        self._file.write_bytes(bytes(_BYTES))
        self.environment = {"LD_PRELOAD": str(_library(folder)), "ZTELEOP_CLOCKS": str(self._file)}
        """What its processes need."""

    def set(self, *, day: float = 0.0, start: float = 0.0) -> None:
        """Shift the time of day and the time since the start, by seconds against the real ones."""
        offsets = bytearray(_BYTES)
        pack_into("=qq", offsets, 0, round(day * 1e9), round(start * 1e9))
        with self._file.open("r+b") as file:
            file.write(offsets)


def _library(folder: Path) -> Path:
    """Return the library in that folder, compiled at the first call; skip the test where that cannot be."""
    made = folder / "clocks.so"
    if made.exists():
        return made
    compiler = shutil.which("cc")
    if sys.platform != "linux" or not compiler:
        pytest.skip("clocks that can be set need Linux and a C compiler named cc (sudo apt install gcc)")
    half = made.with_suffix(f".{os.getpid()}")
    subprocess.run([compiler, *STRICT, "-o", str(half), str(SOURCE)], check=True)
    half.rename(made)
    return made
