"""Empties a ring in a thread that waits for it, and hands over in the loop."""

import threading
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from zteleop.bus.loop import Loop
from zteleop.bus.session import Inbox, Sample
from zteleop.machine import signals


class Pump:
    """Wakes the loop for an inbox's handler.

    Its thread takes one sample and waits until the loop has emptied the ring, one message a
    round: a flood, or a slow handler, costs the other topics one run of that handler at most.
    """

    def __init__(
        self,
        inbox: Inbox,
        handler: Callable[[Any], object],
        loop: Loop,
    ) -> None:
        self._inbox = inbox
        self._handler = handler
        self._loop = loop
        self._sample: Sample | None = None
        self._emptied = threading.Lock()  # held while the loop is at work; an Event costs three times as much
        self._emptied.acquire()
        self._closed = False
        self._thread = threading.Thread(target=self._run, name="inbox", daemon=True)
        signals.start(self._thread)

    def close(self) -> None:
        """End the thread; the session must be closed first."""
        self._closed = True
        self._go_on()
        self._thread.join()

    def _run(self) -> None:
        try:
            self._wait()
        except BaseException as error:  # an inbox that nobody empties any more must not go unnoticed
            self._loop.fail(error)

    def _wait(self) -> None:
        receive = self._inbox.ring.recv
        while not self._closed:
            try:
                self._sample = receive()
            except EOFError:
                return
            if self._closed:  # the loop will not come for it any more
                return
            self._loop.call_soon(self._hand_over)
            self._emptied.acquire()

    def _hand_over(self) -> None:
        sample = self._sample
        try:
            received = sample and self._inbox.read(sample)
            if received is not None:
                self._handler(received)
        finally:
            self._go_on_with_the_rest()

    def _go_on_with_the_rest(self) -> None:
        if not self._closed:
            self._sample = self._inbox.ring.try_recv()
            if self._sample is None:
                self._inbox.lag.is_over()
                self._go_on()
            else:
                self._inbox.lag.goes_on()
                self._loop.call_next(self._hand_over)

    def _go_on(self) -> None:
        with suppress(RuntimeError):  # nobody waits
            self._emptied.release()
