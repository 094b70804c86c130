"""A terminal, seen from the side where somebody sits: keys go in, and what is shown is taken away."""

import os
import pty
import select
import threading
import time
from contextlib import suppress

LEFT = b"a"
"""The key that turns to the left."""
PRESS = 0.7
"""s between key presses: any faster, and they are those of a key that is held."""


class Terminal:
    """Presses a key again and again, as somebody who does not give up, until `hands_off`."""

    def __init__(self) -> None:
        self.hands_off = False
        self._master, self.device = pty.openpty()
        self._ear, self._bell = os.pipe()
        self._thread = threading.Thread(target=self._run, name="terminal", daemon=True)
        self._thread.start()

    def type(self, keys: bytes) -> None:
        os.write(self._master, keys)

    def close(self) -> None:
        """Close it, as when its window is closed: whoever runs in it is told."""
        with suppress(OSError):  # it is closed already
            os.write(self._bell, b"!")
        self._thread.join()

    def _run(self) -> None:
        due = time.monotonic() + PRESS
        with suppress(OSError):  # nobody holds the other end any more
            while self._ear not in (heard := self._wait(due)):
                if heard:
                    os.read(self._master, 65536)
                elif not self.hands_off:
                    self.type(LEFT)
                due = due if heard else due + PRESS
        for end in (self._master, self._ear, self._bell):  # here: it stays open while a read waits
            os.close(end)

    def _wait(self, due: float) -> list[int]:
        return select.select([self._ear, self._master], [], [], max(0.0, due - time.monotonic()))[0]
