"""The file of a simulated chip: 256 bytes of registers, then 28 of faults that somebody has put in."""

import fcntl
import os
from mmap import mmap
from typing import Self

from zteleop.drivers.chip import POWER_UP, SIZE
from zteleop.errors import DeviceError

FAULTS = slice(SIZE, SIZE + 28)
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
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        raise _refusal(path, error) from error


class ChipMemory:
    """The bytes of the chip in a file; when another file takes its place, those of that one.

    A chip whose file is removed is one that has lost its supply: the next is switched on. Whoever held
    on to the old bytes would go on seeing, or writing, pulses that nobody else sees.
    """

    def __init__(self, path: str, access: int) -> None:
        self._path = path
        self._access = access
        self._open()

    def __getitem__(self, place: slice) -> bytes:
        return self.present()[place]

    def __setitem__(self, place: slice, data: bytes) -> None:
        self.present()[place] = data

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        self._memory.close()

    def present(self) -> mmap:
        """Return the bytes of the file that is there now, for what is done with them at once."""
        try:
            found = os.stat(self._path)
            same = (found.st_ino, found.st_size) == (self._number, FILE_SIZE)
        except OSError:
            same = False
        if not same:  # of a file that somebody cut short, the bytes that are gone must not be touched
            before = self._memory
            self._open()
            before.close()
        return self._memory

    def _open(self) -> None:
        file = open_file(self._path)
        try:
            self._memory = mmap(file, FILE_SIZE, access=self._access)
            self._number = os.fstat(file).st_ino
        except (OSError, ValueError) as error:  # ValueError: cut short meanwhile
            raise _refusal(self._path, error) from error
        finally:
            os.close(file)


def map_file(path: str, access: int) -> ChipMemory:
    """Return the chip in that file as memory; switch it on if there is none.

    Raises DeviceError when the file cannot be opened.
    """
    return ChipMemory(path, access)


def _switch_on(file: int) -> None:
    """Give a file that is not a chip the registers of one that has just got power."""
    fcntl.flock(file, fcntl.LOCK_EX)  # two processes may start at once
    size = os.fstat(file).st_size
    if size != FILE_SIZE:
        os.ftruncate(file, FILE_SIZE)
        if size != SIZE:  # else it is a chip from before there were faults
            os.pwrite(file, POWER_UP + bytes(FILE_SIZE - SIZE), 0)
    fcntl.flock(file, fcntl.LOCK_UN)  # a mapping keeps a copy of the file open, and with it the lock


def _refusal(path: str, error: OSError | ValueError) -> DeviceError:
    why = error.strerror if isinstance(error, OSError) else error
    return DeviceError(f"cannot open the simulated chip {path}: {why}; set path under [drivers.simulated]")
