"""The file of a simulated chip: 256 bytes of registers, then 16 of faults that somebody has put in."""

import fcntl
import os
from mmap import mmap

from zteleop.drivers.chip import POWER_UP, SIZE
from zteleop.errors import DeviceError

FAULTS = slice(SIZE, SIZE + 16)
FILE_SIZE = FAULTS.stop


def open_file(path: str) -> int:
    """Return a descriptor of the chip in that file; switch it on if there is none.

    Raises DeviceError when the file cannot be opened.
    """
    try:
        os.makedirs(os.path.dirname(path) or ".", mode=0o700, exist_ok=True)
        file = os.open(path, os.O_RDWR | os.O_CREAT, 0o600)
        try:
            _switch_on(file)
        except BaseException:
            os.close(file)
            raise
        return file
    except OSError as error:
        raise _refusal(path, error) from error


def map_file(path: str, access: int) -> mmap:
    """Return the chip in that file as memory; switch it on if there is none.

    Raises DeviceError when the file cannot be opened.
    """
    file = open_file(path)
    try:
        return mmap(file, FILE_SIZE, access=access)
    except OSError as error:
        raise _refusal(path, error) from error
    finally:
        os.close(file)


def _switch_on(file: int) -> None:
    """Give a file that is not a chip the registers of one that has just got power."""
    fcntl.flock(file, fcntl.LOCK_EX)  # two processes may start at once
    size = os.fstat(file).st_size
    if size != FILE_SIZE:
        os.ftruncate(file, FILE_SIZE)
        if size != SIZE:  # else it is a chip from before there were faults
            os.pwrite(file, POWER_UP + bytes(FILE_SIZE - SIZE), 0)
    fcntl.flock(file, fcntl.LOCK_UN)  # a mapping keeps a copy of the file open, and with it the lock


def _refusal(path: str, error: OSError) -> DeviceError:
    words = f"cannot open the simulated chip {path}: {error.strerror}; set path under [drivers.simulated]"
    return DeviceError(words)
