"""One actuator a chip: a lock that ends with its process and says who holds it."""

import fcntl
import os
import stat

from zteleop.errors import DeviceError


class Lock:
    """An exclusive lock on `path`, which also holds the owner's process id."""

    def __init__(self, path: str, what: str) -> None:
        """Take the lock, or raise DeviceError saying which process drives `what`."""
        self._file: int | None = _open(path)
        try:
            fcntl.flock(self._file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError as error:
            owner = os.pread(self._file, 20, 0).decode("ascii", "replace").strip() or "(unknown)"
            self.release()
            raise DeviceError(f"{what} is driven by process {owner} already; {_ended(owner)}") from error
        os.ftruncate(self._file, 0)
        os.pwrite(self._file, f"{os.getpid()}\n".encode(), 0)

    def fileno(self) -> int | None:
        """Return the descriptor: the lock holds for as long as any process has it open."""
        return self._file

    def release(self) -> None:
        """Let others drive; the file stays, because removing it would let two lock two files of one name."""
        if self._file is not None:
            os.close(self._file)
            self._file = None


def _ended(owner: str) -> str:
    how = f"Ctrl-C where it runs, or kill {owner}" if owner.isdigit() else "Ctrl-C where it runs"
    return f"stop it first ({how})"


def machine_folder() -> str:
    """Return the folder for locks that all users of the machine share."""
    try:
        shared = (
            os.stat("/run/lock").st_mode & stat.S_IWOTH
        )  # asked of the mode: the same answer for all users
    except OSError:
        shared = 0
    return "/run/lock" if shared else "/tmp"


def _open(path: str) -> int:
    try:
        file = _open_shared(path)
    except OSError as error:
        raise DeviceError(f"cannot open the lock {path}: {error.strerror}; check who owns it") from error
    if not stat.S_ISREG(os.fstat(file).st_mode):  # a pipe would make whoever reads its owner wait for ever
        os.close(file)
        raise DeviceError(f"the lock {path} is no file; see what it is, and remove it")
    return file


def _open_shared(path: str) -> int:
    try:
        # Linux refuses O_CREAT on another user's file in a sticky folder (fs.protected_regular).
        return os.open(path, os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK)
    except FileNotFoundError:
        file = os.open(path, os.O_RDWR | os.O_NOFOLLOW | os.O_CREAT, 0o666)
        os.fchmod(file, 0o666)  # the umask must not keep other users of the bus out
        return file
