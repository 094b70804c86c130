"""Notices that whoever started this process has died, before the files that both hold tell it.

A socket of a process that is killed ends with the last of its threads; those of ordinary priority may wait
for a core before they do.
"""

import ctypes
import signal
import sys
from collections.abc import Callable

PR_SET_PDEATHSIG = 1  # <linux/prctl.h>
NOTICE = signal.SIGURG
"""which by itself does nothing"""


def notice(act: Callable[[], object]) -> None:
    """Call `act`, in a signal handler, when the thread that started this process ends; Linux alone tells.

    Where it has ended already nobody is told: whoever must know looks at a file as well.
    """
    if sys.platform == "linux":
        signal.signal(NOTICE, lambda *_: act())
        ctypes.CDLL(None).prctl(PR_SET_PDEATHSIG, NOTICE)
