"""The one clock. It counts on while the machine sleeps, so that a closed lid is heard as silence."""

import time

from zteleop.messages import Time

_BOOTTIME: int | None = getattr(time, "CLOCK_BOOTTIME", None)


def now() -> float:
    """Return seconds since this machine started; never set, never stepped."""
    return time.monotonic() if _BOOTTIME is None else time.clock_gettime(_BOOTTIME)


def stamp() -> Time:
    """Return the time of day, for headers; nothing is decided by it."""
    sec, nanosec = divmod(time.time_ns(), 1_000_000_000)
    return Time(sec, nanosec)
