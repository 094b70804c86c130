"""Turns of a loop for what waits in the rings that share one wire."""

from collections.abc import Callable
from typing import Any

from zteleop.bus.loop import Loop
from zteleop.bus.session import Inbox


class Turns:
    """Hands what waits in a ring to its handler, one message a round of the loop."""

    def __init__(self, inbox: Inbox, handler: Callable[[Any], object], loop: Loop) -> None:
        self._inbox = inbox
        self._handler = handler
        self._loop = loop
        self._waits = False
        self._closed = False

    def wake(self) -> None:
        """Take a turn soon; for the loop's own thread."""
        if not self._waits:
            self._waits = True
            self._loop.call_next(self._hand_over)

    def close(self) -> None:
        self._closed = True

    def _hand_over(self) -> None:
        self._waits = False
        ring: Any = self._inbox.ring
        if self._closed or ring.is_empty:
            return
        sample = ring.try_recv()
        if not ring.is_empty:
            self.wake()
        received = self._inbox.read(sample)
        if received is not None:
            self._handler(received)
