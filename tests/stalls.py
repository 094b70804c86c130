"""For how long, at a stretch, a process of a test wanted a core and had none."""

import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

from zteleop.chaos.waiting import Meter

EVERY = 0.1
"""s between two looks; a wait shows in the look after its end, and whole"""


class Stalls:
    """Looks at all processes of a test while it runs."""

    def __init__(self, pids: Callable[[], Iterable[int]]) -> None:
        self._pids = pids
        self.longest = 0.0
        """s, since the test began"""

    @contextmanager
    def watched(self, wanted: bool) -> Iterator[None]:
        """Look meanwhile, if it is wanted."""
        self.longest, ended = 0.0, threading.Event()
        thread = threading.Thread(target=self._look, args=(ended,), daemon=True)
        if wanted:
            thread.start()
        try:
            yield
        finally:
            ended.set()
            if wanted:
                thread.join()

    def _look(self, ended: threading.Event) -> None:
        meter: Meter | None = None
        over = False
        while not over:  # most tests are, by the first look
            over = ended.wait(EVERY)
            before, meter = meter, Meter(self._pids)
            if before:
                self.longest = max(self.longest, before.longest)
