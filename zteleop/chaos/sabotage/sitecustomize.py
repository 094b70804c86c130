"""Every Python process of a bench imports this at its start, and does what an order says at SIGUSR1.

Python looks for a module of this name by itself; the bench puts this folder in front of its path.
"""

import atexit
import ctypes
import os
import signal
import sys
import threading
import time
from types import FrameType

ORDER = "ZTELEOP_CHAOS_ORDER"
BENCH = "ZTELEOP_CHAOS_BENCH"
PR_SET_PDEATHSIG = 1  # <linux/prctl.h>


class SabotageError(Exception):
    """An error that nobody foresaw."""


def obey(number: int, frame: FrameType | None) -> None:
    """Do the order of the moment: `raise THREAD` or `hang`."""
    with open(os.environ[ORDER]) as file:
        word, _, name = file.read().partition(" ")
    if word == "hang":
        atexit.register(time.sleep, 3600.0)
        os._exit = lambda status: time.sleep(3600.0)  # type: ignore[assignment,return-value]
    if (word, name) == ("raise", "MainThread"):
        raise SabotageError  # signals are handled in that very thread
    for thread in threading.enumerate() if word == "raise" else ():
        if thread.name.startswith(name):
            ctypes.pythonapi.PyThreadState_SetAsyncExc(
                ctypes.c_ulong(thread.ident or 0), ctypes.py_object(SabotageError)
            )


if os.environ.get(BENCH) == str(os.getppid()) and sys.platform == "linux":
    ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, signal.SIGKILL)  # whoever drives ends with the bench
if ORDER in os.environ:
    signal.signal(signal.SIGUSR1, obey)
