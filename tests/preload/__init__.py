"""A /dev/i2c-1 of our own: the real smbus2 and the real driver against a PCA9685 in a file, without root."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from zteleop.drivers.chip_file import open_file

SOURCE = Path(__file__).with_name("i2cdev.c")
STRICT = ("-std=gnu11", "-Wall", "-Wextra", "-Werror", "-Wno-unused-parameter")


def library(folder: Path) -> Path:
    """Return the library in that folder, compiled at the first call; skip the test where that cannot be."""
    made = folder / "i2cdev.so"
    if made.exists():
        return made
    compiler = shutil.which("cc")
    if sys.platform != "linux" or not compiler:
        pytest.skip("the preloaded i2c-dev needs Linux and a C compiler named cc (sudo apt install gcc)")
    half = made.with_suffix(f".{os.getpid()}")
    command = [compiler, *STRICT, "-shared", "-fPIC", "-O2", "-o", str(half), str(SOURCE), "-ldl"]
    subprocess.run(command, check=True)
    half.rename(made)  # two sessions may compile into one folder
    return made


def environment(library: Path, chip: str | Path, address: int = 0x40) -> dict[str, str]:
    """Return what a process needs in its environment to find the chip of that file on /dev/i2c-1."""
    os.close(open_file(str(chip)))
    others = os.environ.get("LD_PRELOAD")
    return {
        "LD_PRELOAD": f"{library}:{others}" if others else str(library),
        "ZTELEOP_I2CDEV_FILE": str(chip),
        "ZTELEOP_I2CDEV_ADDRESS": f"0x{address:02x}",
    }


def run(folder: Path, module: str, *arguments: str) -> Any:
    """Run a module of this folder with that library and a chip of its own; return what it says in JSON."""
    done = subprocess.run(
        [sys.executable, "-m", f"preload.{module}", *arguments],
        env=os.environ | environment(library(folder), folder / "chip"),
        cwd=Path(__file__).parents[1],
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)
